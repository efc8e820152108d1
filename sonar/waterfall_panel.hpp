// What the pictures of tracks share (echo traces, side-scan waterfalls, bathymetry, scans):
// palettes, resampling, axes, legends and scale bars on a canvas. For people only: no data pass
// through here. Pure functions; any thread. Pixels, y down.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "sonar/canvas.hpp"

namespace neritic::sonar {

inline constexpr Color kPlotBackground{0.035f, 0.042f, 0.052f};
inline constexpr Color kPlotText{0.80f, 0.87f, 0.90f};
inline constexpr Color kPlotLine{0.62f, 0.80f, 0.86f};

struct PlotBox {
  double left = 0, top = 0, right = 0, bottom = 0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

enum class Palette {
  kBronze,  // black, umber, bronze, gold, cream: side-scan and scanning sonars
  kEcho,    // dark blue over green and yellow to red: echo sounders
  kDepth,   // violet (0, deep) over blue and green to red (1, shallow): charts
};
// value is held to 0 to 1; NaN is 0.
Color palette_color(Palette palette, double value);

// Multiples of 1, 2 or 5 times a power of ten in [from, to] (either order), about count of them.
// Empty where the span is not positive and finite.
std::vector<double> nice_ticks(double from, double to, double count);
// The largest 1, 2 or 5 times a power of ten that is at most value; value > 0.
double nice_at_most(double value);
// "12.5", without noise of binary fractions and without "-0".
std::string number_text(double value);

// values[rows][columns] on width x height pixels, each the mean of the area it covers. NaN takes no
// part; a pixel with nothing else is NaN. CHECKs that sizes match and are not zero.
ImageF32 resample_area(std::span<const float> values, std::size_t rows, std::size_t columns,
                       std::uint32_t width, std::uint32_t height);

// The value below which a fraction of what is above zero lies; 1 where nothing is.
double percentile_of_heard(std::span<const float> values, double fraction);

// Shades (0 to 1, one channel; NaN leaves the ground) from the box's upper left corner on.
void draw_shades(Canvas& canvas, const PlotBox& box, const ImageF32& shades, Palette palette);

// unit: the size on which all lettering is given, 1 for a panel of some 900 px.
// Ticks with numbers at the left of the box, from its top to its bottom, and faint lines across.
void draw_left_axis(Canvas& canvas, const PlotBox& box, double at_top, double at_bottom,
                    const std::string& label, double unit);
// The same below it, from its left to its right.
void draw_bottom_axis(Canvas& canvas, const PlotBox& box, double at_left, double at_right,
                      const std::string& label, double unit);
void draw_frame(Canvas& canvas, const PlotBox& box, double unit);
// A vertical colour bar; the palette's 0 is at its bottom. Numbers at its right.
void draw_legend(Canvas& canvas, const PlotBox& bar, Palette palette, double at_bottom,
                 double at_top, const std::string& label, double unit);
// The same with marks where they are told, 0 at its bottom to 1.
struct LegendMark {
  double at;
  std::string text;
};
void draw_legend(Canvas& canvas, const PlotBox& bar, Palette palette,
                 std::span<const LegendMark> marks, const std::string& label, double unit);
// A bar of a round length in metres, at most max_px long, its left end at (x, y).
void draw_scale_bar(Canvas& canvas, double x, double y, double px_per_m, double max_px,
                    double unit);
// Title and the line under it, at the upper left.
void draw_title(Canvas& canvas, const std::string& title, const std::string& subtitle, double unit);

}  // namespace neritic::sonar
