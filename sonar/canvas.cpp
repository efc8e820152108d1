#include "sonar/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sonar/stroke_font.hpp"

namespace neritic::sonar {
namespace {

// The next code point of a UTF-8 text; a broken sequence gives its bytes one by one.
std::uint32_t next_code_point(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t first = byte(0);
  if ((first & 0xe0) == 0xc0 && text.size() > 1) {
    const std::uint32_t code = (first & 0x1f) << 6 | (byte(1) & 0x3fu);
    text.remove_prefix(2);
    return code;
  }
  text.remove_prefix(1);
  return first;
}

double glyph_width(std::uint32_t code) {
  const std::string_view strokes = strokes_of(code);
  if (strokes.empty()) return kBlankWidth;
  double width = 0.0;
  for (std::size_t i = 0; i < strokes.size(); i += strokes[i] == ' ' ? 1 : 2)
    if (strokes[i] != ' ') width = std::max(width, stroke_x(strokes[i]));
  return width;
}

std::uint8_t to_byte(float v) {
  return static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f);
}

}  // namespace

Color mix(const Color& a, const Color& b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t,
          a.alpha + (b.alpha - a.alpha) * t};
}

Canvas::Canvas(std::uint32_t width, std::uint32_t height, const Color& background)
    : image_(width, height, 3) {
  for (std::size_t i = 0; i < image_.data.size(); i += 3) {
    image_.data[i] = to_byte(background.r);
    image_.data[i + 1] = to_byte(background.g);
    image_.data[i + 2] = to_byte(background.b);
  }
}

void Canvas::blend(int x, int y, const Color& color, float coverage) {
  if (x < 0 || y < 0 || x >= static_cast<int>(width()) || y >= static_cast<int>(height())) return;
  const float a = std::clamp(color.alpha * coverage, 0.0f, 1.0f);
  std::uint8_t* p = &image_.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
  const float rgb[3] = {color.r, color.g, color.b};
  for (int i = 0; i < 3; ++i) p[i] = to_byte(p[i] / 255.0f * (1.0f - a) + rgb[i] * a);
}

void Canvas::fill_rectangle(double x0, double y0, double x1, double y1, const Color& color) {
  for (int y = static_cast<int>(std::floor(y0)); y < y1; ++y)
    for (int x = static_cast<int>(std::floor(x0)); x < x1; ++x) {
      const double w = std::min<double>(x + 1, x1) - std::max<double>(x, x0);
      const double h = std::min<double>(y + 1, y1) - std::max<double>(y, y0);
      if (w > 0.0 && h > 0.0) blend(x, y, color, static_cast<float>(w * h));
    }
}

void Canvas::segment(double x0, double y0, double x1, double y1, double width_px,
                     const Color& color) {
  const double reach = width_px / 2.0 + 1.0;
  const double dx = x1 - x0, dy = y1 - y0, square = dx * dx + dy * dy;
  const auto clamp_to = [](double v, double max) {
    return static_cast<int>(std::clamp(v, 0.0, max));
  };
  const int top = clamp_to(std::min(y0, y1) - reach, height()),
            bottom = clamp_to(std::max(y0, y1) + reach + 1, height()),
            left = clamp_to(std::min(x0, x1) - reach, width()),
            right = clamp_to(std::max(x0, x1) + reach + 1, width());
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const double px = x + 0.5 - x0, py = y + 0.5 - y0;
      const double t = square > 0.0 ? std::clamp((px * dx + py * dy) / square, 0.0, 1.0) : 0.0;
      const double distance = std::hypot(px - t * dx, py - t * dy);
      const double coverage =
          std::clamp(width_px / 2.0 + 0.5 - distance, 0.0, std::min(1.0, width_px));
      if (coverage > 0.0) blend(x, y, color, static_cast<float>(coverage));
    }
}

void Canvas::arc(double cx, double cy, double radius_px, double from_rad, double to_rad,
                 double width_px, const Color& color) {
  const double reach = radius_px + width_px;
  const double middle = (from_rad + to_rad) / 2.0, half = (to_rad - from_rad) / 2.0;
  const int top = std::max(0, static_cast<int>(cy - reach)),
            bottom = std::min(static_cast<int>(height()), static_cast<int>(cy + reach) + 2),
            left = std::max(0, static_cast<int>(cx - reach)),
            right = std::min(static_cast<int>(width()), static_cast<int>(cx + reach) + 2);
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const double px = x + 0.5 - cx, py = y + 0.5 - cy;
      const double off = std::abs(std::hypot(px, py) - radius_px);
      if (off > width_px / 2.0 + 0.5) continue;
      const double turn = std::remainder(std::atan2(px, -py) - middle, 2.0 * std::numbers::pi);
      if (std::abs(turn) > half) continue;
      const double coverage = std::clamp(width_px / 2.0 + 0.5 - off, 0.0, std::min(1.0, width_px));
      blend(x, y, color, static_cast<float>(coverage));
    }
}

double Canvas::text_width(double size_px, std::string_view text) {
  double units = 0.0;
  while (!text.empty()) units += glyph_width(next_code_point(text)) + kLetterGap;
  return std::max(0.0, units - kLetterGap) * size_px / kCapitalHeight;
}

void Canvas::text(double x, double y, double size_px, std::string_view text, const Color& color,
                  Align align, double weight_px) {
  const double unit = size_px / kCapitalHeight;
  const double weight = weight_px > 0.0 ? weight_px : std::max(1.2, size_px * 0.12);
  if (align == Align::kCenter) x -= text_width(size_px, text) / 2.0;
  if (align == Align::kRight) x -= text_width(size_px, text);
  while (!text.empty()) {
    const std::uint32_t code = next_code_point(text);
    const std::string_view s = strokes_of(code);
    const auto px = [&](std::size_t i) { return x + stroke_x(s[i]) * unit; };
    const auto py = [&](std::size_t i) { return y - stroke_y(s[i + 1]) * unit; };
    for (std::size_t i = 0; i < s.size();) {
      if (s[i] == ' ') {
        ++i;
        continue;
      }
      if (i + 2 < s.size() && s[i + 2] != ' ')
        segment(px(i), py(i), px(i + 2), py(i + 2), weight, color);
      i += 2;
    }
    x += (glyph_width(code) + kLetterGap) * unit;
  }
}

}  // namespace neritic::sonar
