// Drawing on a picture with smooth edges: lines, arcs, polygons and text, for panels, sheets and
// instruments. The picture is RGB, or RGBA with its colour multiplied by alpha. Pixel coordinates,
// y down, the first pixel's centre at (0.5, 0.5); angles are bearings, clockwise from up, in
// radians. Shapes are clipped at the picture's edges. The same calls give the same bytes. One
// owner, one thread.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/image.hpp"
#include "engine/core/math.hpp"
#include "engine/draw2d/color.hpp"
#include "engine/draw2d/font.hpp"

namespace neritic::draw2d {

enum class Align { kLeft, kCenter, kRight };            // which part of the text stands at x
enum class VerticalAlign { kBaseline, kMiddle, kTop };  // of the capitals, at y

class Canvas {
 public:
  Canvas(std::uint32_t width, std::uint32_t height, const Color& background);
  // RGB or premultiplied RGBA, to be drawn over. CHECKs that the picture has three or four
  // channels.
  explicit Canvas(ImageU8 picture);

  std::uint32_t width() const { return image_.width; }
  std::uint32_t height() const { return image_.height; }

  // All channels to 0: black, or of RGBA nothing at all. Fonts stay open.
  void clear();
  // Mixes the color over one pixel; coverage 0 to 1. No channel of RGBA becomes larger than alpha.
  void blend(int x, int y, const Color& color, float coverage);
  void fill_rectangle(double x0, double y0, double x1, double y1, const Color& color);
  // A closed polygon; what it winds around at least once is filled.
  void fill_polygon(std::span<const Vec2> corners, const Color& color);
  void disc(double x, double y, double radius_px, const Color& color);
  // A line with round ends.
  void segment(double x0, double y0, double x1, double y1, double width_px, const Color& color);
  // Segments joined to one line, which covers a pixel once even where it bends or crosses itself.
  void polyline(std::span<const Vec2> points, double width_px, const Color& color);
  // Part of a ring around (cx, cy), with straight ends; a turn of 2 pi or more closes it.
  void arc(double cx, double cy, double radius_px, double from_rad, double to_rad, double width_px,
           const Color& color);

  // size_px is the height of capitals (font.hpp). At 8 px and more every letter can be read.
  void text(double x, double y, double size_px, std::string_view utf8, const Color& color,
            Align align = Align::kLeft, Face face = Face::kRegular,
            VerticalAlign vertical = VerticalAlign::kBaseline);
  double text_width(double size_px, std::string_view utf8, Face face = Face::kRegular);
  // The text, or its beginning with "…" where it is wider than max_px. Empty where not even "…"
  // has room.
  std::string shortened(double size_px, std::string_view utf8, double max_px,
                        Face face = Face::kRegular);

  const ImageU8& image() const { return image_; }
  ImageU8 take() { return std::move(image_); }

 private:
  PixelBox bounds() const;
  // Whole pixels that a box touches, clipped to the picture.
  PixelBox pixels_of(double left, double top, double right, double bottom) const;
  void paint(const Mask& mask, const Color& color);
  Font& font(Face face);

  ImageU8 image_;
  std::array<std::optional<Font>, 2> fonts_;  // by Face; opened when first used
};

}  // namespace neritic::draw2d
