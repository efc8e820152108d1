#include "engine/draw2d/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/draw2d/polygon.hpp"
#include "engine/draw2d/utf8.hpp"

namespace neritic::draw2d {
namespace {

std::uint8_t to_byte(float v) {
  return static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f);
}

// A channel's byte under a share of a colour; the fourth is the coverage.
std::uint8_t blended(float below, const Color& color, float share, std::size_t channel) {
  const float over[4] = {color.r, color.g, color.b, 1.0f};
  return to_byte(below / 255.0f * (1.0f - share) + over[channel] * share);
}

// The part of a pixel that a stroke covers, by the distance of its middle line from the pixel's
// centre: a ramp one pixel wide at the edge; a stroke thinner than a pixel is fainter instead.
double stroke_coverage(double distance_px, double width_px) {
  return std::clamp(width_px / 2.0 + 0.5 - distance_px, 0.0, std::clamp(width_px, 0.0, 1.0));
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a, to = p - a;
  const double square = glm::dot(along, along);
  const double t = square > 0.0 ? std::clamp(glm::dot(to, along) / square, 0.0, 1.0) : 0.0;
  return glm::length(to - t * along);
}

}  // namespace

Canvas::Canvas(std::uint32_t width, std::uint32_t height, const Color& background)
    : image_(width, height, 3) {
  for (std::size_t i = 0; i < image_.data.size(); i += 3) {
    image_.data[i] = to_byte(background.r);
    image_.data[i + 1] = to_byte(background.g);
    image_.data[i + 2] = to_byte(background.b);
  }
}

Canvas::Canvas(ImageU8 picture) : image_(std::move(picture)) {
  NERITIC_CHECK(image_.channels == 3 || image_.channels == 4, "{} channels", image_.channels);
}

PixelBox Canvas::bounds() const {
  return {0, 0, static_cast<int>(width()), static_cast<int>(height())};
}

PixelBox Canvas::pixels_of(double left, double top, double right, double bottom) const {
  const auto clamped = [](double v, std::uint32_t size) {
    return v > 0.0 ? static_cast<int>(std::min(v, double(size))) : 0;  // NaN: 0
  };
  return {clamped(std::floor(left), width()), clamped(std::floor(top), height()),
          clamped(std::ceil(right), width()), clamped(std::ceil(bottom), height())};
}

void Canvas::clear() {
  std::ranges::fill(image_.data, std::uint8_t{0});
}

void Canvas::blend(int x, int y, const Color& color, float coverage) {
  if (x < 0 || y < 0 || x >= static_cast<int>(width()) || y >= static_cast<int>(height())) return;
  const float a = std::clamp(color.alpha * coverage, 0.0f, 1.0f);
  std::uint8_t* p = &image_.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
  for (std::uint32_t i = 0; i < image_.channels; ++i) p[i] = blended(p[i], color, a, i);
}

void Canvas::paint(const Mask& mask, const Color& color) {
  // Most of a large area is covered whole: there a table gives what each byte becomes.
  constexpr std::size_t kLarge = 4096;
  std::array<std::array<std::uint8_t, 256>, 4> whole;
  const bool large = mask.coverage.size() >= kLarge;
  const float a = std::clamp(color.alpha, 0.0f, 1.0f);
  for (std::size_t v = 0; large && v < 256; ++v)
    for (std::size_t c = 0; c < 4; ++c) whole[c][v] = blended(static_cast<float>(v), color, a, c);
  const PixelBox box = mask.box.intersect(bounds());
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x) {
      const std::uint8_t coverage = mask.at(x, y);
      if (coverage == 0) continue;
      if (!large || coverage < 255) {
        blend(x, y, color, static_cast<float>(coverage) / 255.0f);
        continue;
      }
      std::uint8_t* p = &image_.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
      for (std::uint32_t c = 0; c < 3; ++c) p[c] = whole[c][p[c]];
      if (image_.channels == 4) p[3] = whole[3][p[3]];
    }
}

void Canvas::fill_rectangle(double x0, double y0, double x1, double y1, const Color& color) {
  const PixelBox box = pixels_of(x0, y0, x1, y1);
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x) {
      const double w = std::min<double>(x + 1, x1) - std::max<double>(x, x0);
      const double h = std::min<double>(y + 1, y1) - std::max<double>(y, y0);
      if (w > 0.0 && h > 0.0) blend(x, y, color, static_cast<float>(w * h));
    }
}

void Canvas::fill_polygon(std::span<const Vec2> corners, const Color& color) {
  paint(polygon_mask(corners, bounds()), color);
}

void Canvas::disc(double x, double y, double radius_px, const Color& color) {
  segment(x, y, x, y, 2.0 * radius_px, color);
}

void Canvas::segment(double x0, double y0, double x1, double y1, double width_px,
                     const Color& color) {
  const Vec2 a(x0, y0), b(x1, y1);
  const double reach = width_px / 2.0 + 1.0;
  const PixelBox box = pixels_of(std::min(x0, x1) - reach, std::min(y0, y1) - reach,
                                 std::max(x0, x1) + reach, std::max(y0, y1) + reach);
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x) {
      const double coverage =
          stroke_coverage(distance_to_segment({x + 0.5, y + 0.5}, a, b), width_px);
      if (coverage > 0.0) blend(x, y, color, static_cast<float>(coverage));
    }
}

void Canvas::polyline(std::span<const Vec2> points, double width_px, const Color& color) {
  if (points.empty()) return;
  Vec2 low = points[0], high = points[0];
  for (const Vec2& p : points) low = glm::min(low, p), high = glm::max(high, p);
  const double reach = width_px / 2.0 + 1.0;
  Mask mask(pixels_of(low.x - reach, low.y - reach, high.x + reach, high.y + reach));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 a = points[i], b = points[std::min(i + 1, points.size() - 1)];
    if (i > 0 && i + 1 == points.size()) break;
    const PixelBox box = pixels_of(std::min(a.x, b.x) - reach, std::min(a.y, b.y) - reach,
                                   std::max(a.x, b.x) + reach, std::max(a.y, b.y) + reach);
    for (int y = box.top; y < box.bottom; ++y)
      for (int x = box.left; x < box.right; ++x) {
        const double coverage =
            stroke_coverage(distance_to_segment({x + 0.5, y + 0.5}, a, b), width_px);
        std::uint8_t& at = mask.at(x, y);
        at = std::max(at, to_byte(static_cast<float>(coverage)));
      }
  }
  paint(mask, color);
}

void Canvas::arc(double cx, double cy, double radius_px, double from_rad, double to_rad,
                 double width_px, const Color& color) {
  const double reach = radius_px + width_px / 2.0 + 1.0;
  const double middle = (from_rad + to_rad) / 2.0, half = (to_rad - from_rad) / 2.0;
  const bool closed = half >= kPi - 1e-9;
  const PixelBox box = pixels_of(cx - reach, cy - reach, cx + reach, cy + reach);
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x) {
      const double px = x + 0.5 - cx, py = y + 0.5 - cy, r = std::hypot(px, py);
      double coverage = stroke_coverage(std::abs(r - radius_px), width_px);
      if (coverage <= 0.0) continue;
      if (!closed) {
        const double turn = std::abs(std::remainder(std::atan2(px, -py) - middle, 2.0 * kPi));
        coverage *= std::clamp((half - turn) * r + 0.5, 0.0, 1.0);
      }
      if (coverage > 0.0) blend(x, y, color, static_cast<float>(coverage));
    }
}

Font& Canvas::font(Face face) {
  std::optional<Font>& font = fonts_[static_cast<std::size_t>(face)];
  if (!font) font.emplace(face);
  return *font;
}

double Canvas::text_width(double size_px, std::string_view utf8, Face face) {
  return font(face).width(size_px, utf8);
}

std::string Canvas::shortened(double size_px, std::string_view utf8, double max_px, Face face) {
  if (text_width(size_px, utf8, face) <= max_px) return std::string(utf8);
  constexpr std::string_view kEllipsis = "\u2026";
  std::string best;
  for (std::string_view rest = utf8;; take_code_point(rest)) {
    const std::string tried =
        std::string(utf8.substr(0, utf8.size() - rest.size())).append(kEllipsis);
    if (rest.empty() || text_width(size_px, tried, face) > max_px) return best;
    best = tried;
  }
}

void Canvas::text(double x, double y, double size_px, std::string_view utf8, const Color& color,
                  Align align, Face face, VerticalAlign vertical) {
  if (align == Align::kCenter) x -= text_width(size_px, utf8, face) / 2.0;
  if (align == Align::kRight) x -= text_width(size_px, utf8, face);
  if (vertical == VerticalAlign::kMiddle) y += size_px / 2.0;
  if (vertical == VerticalAlign::kTop) y += size_px;
  paint(font(face).rasterize(x, y, size_px, utf8, bounds()), color);
}

}  // namespace neritic::draw2d
