#include "engine/draw2d/font.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <cmath>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/draw2d/utf8.hpp"

namespace neritic::draw2d {
namespace {

constexpr double kSubpixels = 64.0;  // FreeType's unit: 1/64 pixel

// Calls visit(glyph index, x in font units) for each glyph of the text, kerning included; returns
// the advance of the whole.
template <class Visit>
double for_each_glyph(FT_Face face, std::string_view text, Visit&& visit) {
  double x = 0.0;
  FT_UInt before = 0;
  while (!text.empty()) {
    const FT_UInt glyph = FT_Get_Char_Index(face, take_code_point(text));
    FT_Vector kerning{};
    if (before != 0) FT_Get_Kerning(face, before, glyph, FT_KERNING_UNSCALED, &kerning);
    x += static_cast<double>(kerning.x);
    visit(glyph, x);
    NERITIC_CHECK(FT_Load_Glyph(face, glyph, FT_LOAD_NO_SCALE) == 0, "glyph {}", glyph);
    x += static_cast<double>(face->glyph->metrics.horiAdvance);
    before = glyph;
  }
  return x;
}

// Adds an outline (1/64 pixel, y up from the mask's lower edge, x from its left one) to a mask.
void add_outline(FT_Library library, FT_Outline& outline, Mask& mask, const PixelBox& glyph_box) {
  const PixelBox box = glyph_box.intersect(mask.box);
  if (box.empty()) return;
  Mask own(box);
  FT_Outline_Translate(&outline, -FT_Pos(box.left - mask.box.left) * 64,
                       FT_Pos(box.bottom - mask.box.bottom) * 64);
  FT_Bitmap bitmap{};
  bitmap.width = static_cast<unsigned>(box.width());
  bitmap.rows = static_cast<unsigned>(box.height());
  bitmap.pitch = box.width();
  bitmap.buffer = own.coverage.data();
  bitmap.pixel_mode = FT_PIXEL_MODE_GRAY;
  bitmap.num_grays = 256;
  const FT_Error error = FT_Outline_Get_Bitmap(library, &outline, &bitmap);
  NERITIC_CHECK(error == 0, "FreeType error {} at an outline", error);
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x)
      mask.at(x, y) = static_cast<std::uint8_t>(std::min(255, mask.at(x, y) + own.at(x, y)));
}

}  // namespace

void Font::Close::operator()(FT_LibraryRec_* library) const {
  FT_Done_FreeType(library);
}
void Font::Close::operator()(FT_FaceRec_* face) const {
  FT_Done_Face(face);
}

Font::Font(Face face) {
  FT_Library library = nullptr;
  NERITIC_CHECK(FT_Init_FreeType(&library) == 0, "FreeType does not start");
  library_.reset(library);
  const auto file = font_file(face);
  FT_Face opened = nullptr;
  const FT_Error error = FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(file.data()),
                                            static_cast<FT_Long>(file.size()), 0, &opened);
  NERITIC_CHECK(error == 0, "FreeType error {} at the font", error);
  face_.reset(opened);
  const FT_UInt capital = FT_Get_Char_Index(opened, U'H');
  NERITIC_CHECK(FT_Load_Glyph(opened, capital, FT_LOAD_NO_SCALE) == 0, "glyph {}", capital);
  em_per_capital_ = static_cast<double>(opened->units_per_EM) /
                    static_cast<double>(opened->glyph->metrics.horiBearingY);
}

double Font::em_px(double size_px) const {
  NERITIC_CHECK(size_px <= kLargestText_px, "text of {} px, at most {}", size_px, kLargestText_px);
  return std::max(size_px, 0.0) * em_per_capital_;
}

bool Font::has(char32_t code_point) const {
  return FT_Get_Char_Index(face_.get(), code_point) != 0;
}

double Font::width(double size_px, std::string_view utf8) const {
  return for_each_glyph(face_.get(), utf8, [](FT_UInt, double) {}) * em_px(size_px) /
         face_->units_per_EM;
}

InkBox Font::ink(double size_px, std::string_view utf8) const {
  constexpr double kFar = std::numeric_limits<double>::max();
  InkBox box{kFar, kFar, -kFar, -kFar};
  const FT_Face face = face_.get();
  for_each_glyph(face, utf8, [&](FT_UInt glyph, double x) {
    NERITIC_CHECK(FT_Load_Glyph(face, glyph, FT_LOAD_NO_SCALE) == 0, "glyph {}", glyph);
    const FT_Glyph_Metrics& m = face->glyph->metrics;
    if (m.width == 0 || m.height == 0) return;
    const double left = x + static_cast<double>(m.horiBearingX),
                 top = -static_cast<double>(m.horiBearingY);
    box = {std::min(box.left, left), std::min(box.top, top),
           std::max(box.right, left + static_cast<double>(m.width)),
           std::max(box.bottom, top + static_cast<double>(m.height))};
  });
  if (box.left > box.right) return {};
  const double scale = em_px(size_px) / face->units_per_EM;
  return {box.left * scale, box.top * scale, box.right * scale, box.bottom * scale};
}

Mask Font::rasterize(double x, double baseline_y, double size_px, std::string_view utf8,
                     const PixelBox& clip) {
  NERITIC_CHECK(std::isfinite(x) && std::isfinite(baseline_y), "text at {}, {}", x, baseline_y);
  const double em = em_px(size_px);
  if (em < 1.0) return {};  // FreeType has no smaller em; it would be a grey speck anyway
  // Hinting moves edges by up to a pixel, and rounding the baseline by half of one.
  constexpr double kRoom_px = 2.0;
  const InkBox ink = this->ink(size_px, utf8);
  const auto pixel = [](double v, int low, int high) {
    return static_cast<int>(std::clamp(std::floor(v), double(low), double(high)));
  };
  const PixelBox box{pixel(x + ink.left - kRoom_px, clip.left, clip.right),
                     pixel(baseline_y + ink.top - kRoom_px, clip.top, clip.bottom),
                     pixel(x + ink.right + kRoom_px + 1.0, clip.left, clip.right),
                     pixel(baseline_y + ink.bottom + kRoom_px + 1.0, clip.top, clip.bottom)};
  if (box.empty()) return {};
  Mask mask(box);
  const FT_Face face = face_.get();
  // Glyphs first, since loading one at a size undoes what for_each_glyph has loaded.
  struct Placed {
    FT_UInt glyph;
    double x;
  };
  std::vector<Placed> placed;
  const double scale = em / face->units_per_EM;
  for_each_glyph(face, utf8, [&](FT_UInt glyph, double at) {
    placed.push_back({glyph, x + at * scale});
  });
  const FT_Error error =
      FT_Set_Char_Size(face, 0, static_cast<FT_F26Dot6>(std::lround(em * kSubpixels)), 72, 72);
  NERITIC_CHECK(error == 0, "FreeType error {} at an em of {} px", error, em);
  const double row = std::round(baseline_y);
  for (const Placed& p : placed) {
    // Glyphs so far outside that their place has no number in pixels are not drawn.
    if (p.x + 4.0 * em < box.left || p.x - 4.0 * em > box.right) continue;
    NERITIC_CHECK(FT_Load_Glyph(face, p.glyph, FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP) == 0,
                  "glyph {}", p.glyph);
    FT_Outline& outline = face->glyph->outline;
    FT_Outline_Translate(&outline, std::lround((p.x - box.left) * kSubpixels),
                         std::lround((box.bottom - row) * kSubpixels));
    FT_BBox ink_box;
    FT_Outline_Get_CBox(&outline, &ink_box);
    const auto down = [](FT_Pos v) { return static_cast<int>(v >> 6); };
    const auto up = [](FT_Pos v) { return static_cast<int>((v + 63) >> 6); };
    add_outline(library_.get(), outline, mask,
                {box.left + down(ink_box.xMin), box.bottom - up(ink_box.yMax),
                 box.left + up(ink_box.xMax), box.bottom - down(ink_box.yMin)});
  }
  return mask;
}

}  // namespace neritic::draw2d
