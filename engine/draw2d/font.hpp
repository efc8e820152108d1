// Text as coverage: DejaVu Sans by FreeType, hinted vertically only, so that baseline and x-height
// fall on pixel rows while letters keep their widths and stand at fractions of a pixel. The font
// files are part of the program (font_data.cpp), so that text cannot fail at run time. A text is
// UTF-8; a code point without a glyph is drawn as the font's box, bytes that are not UTF-8 as
// U+FFFD. Pixels, y down. A Font belongs to one thread.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "engine/draw2d/mask.hpp"

struct FT_LibraryRec_;
struct FT_FaceRec_;

namespace neritic::draw2d {

enum class Face { kRegular, kBold };

// The bytes of the font's file (TrueType).
std::span<const std::byte> font_file(Face face);

// The box of a text's ink around its origin on the baseline, in pixels, y down. Empty for blanks.
struct InkBox {
  double left = 0, top = 0, right = 0, bottom = 0;
};

class Font {
 public:
  explicit Font(Face face = Face::kRegular);

  // size_px is the height of capitals and digits; the em is 1.37 times as large. Negative and
  // zero sizes have no extent. CHECKs that it is finite and at most kLargestText_px.
  // The advance of the text, kerning included; proportional to the size.
  double width(double size_px, std::string_view utf8) const;
  // Extents of the unhinted outlines; hinting moves an edge by up to a pixel.
  InkBox ink(double size_px, std::string_view utf8) const;
  // The coverage of a text whose origin is at x on the baseline, which is rounded to a whole row.
  // Pixels outside clip are left out.
  Mask rasterize(double x, double baseline_y, double size_px, std::string_view utf8,
                 const PixelBox& clip);
  // Whether the font has a glyph of the code point.
  bool has(char32_t code_point) const;

 private:
  struct Close {
    void operator()(FT_LibraryRec_* library) const;
    void operator()(FT_FaceRec_* face) const;
  };
  double em_px(double size_px) const;

  std::unique_ptr<FT_LibraryRec_, Close> library_;
  std::unique_ptr<FT_FaceRec_, Close> face_;
  double em_per_capital_ = 1.0;
};

// Four capitals fill the longest side of a picture.
inline constexpr double kLargestText_px = 4096.0;

}  // namespace neritic::draw2d
