// Drawing on an RGB picture with smooth edges: segments, arcs, rectangles and a stroke font. For
// polar panels and plots. One owner, one thread. Pixel coordinates, y down, pixel centres at +0.5.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "engine/core/image.hpp"

namespace neritic::sonar {

struct Color {
  float r = 0, g = 0, b = 0, alpha = 1;  // display-referred, 0 to 1
  Color with_alpha(float a) const { return {r, g, b, a}; }
};
Color mix(const Color& a, const Color& b, float t);

enum class Align { kLeft, kCenter, kRight };

class Canvas {
 public:
  Canvas(std::uint32_t width, std::uint32_t height, const Color& background);
  explicit Canvas(ImageU8 rgb) : image_(std::move(rgb)) {}

  std::uint32_t width() const { return image_.width; }
  std::uint32_t height() const { return image_.height; }
  // Blends color over the pixel; outside the picture nothing happens.
  void blend(int x, int y, const Color& color, float coverage);

  void fill_rectangle(double x0, double y0, double x1, double y1, const Color& color);
  // A line with round ends.
  void segment(double x0, double y0, double x1, double y1, double width_px, const Color& color);
  // Around (cx, cy); bearings clockwise from up, radians.
  void arc(double cx, double cy, double radius_px, double from_rad, double to_rad, double width_px,
           const Color& color);
  // y is the baseline; size is the height of capitals. UTF-8 degree signs are known.
  void text(double x, double y, double size_px, std::string_view text, const Color& color,
            Align align = Align::kLeft, double weight_px = 0.0);
  static double text_width(double size_px, std::string_view text);

  const ImageU8& image() const { return image_; }
  ImageU8 take() { return std::move(image_); }

 private:
  ImageU8 image_;
};

}  // namespace neritic::sonar
