// Axes, colour bars, scale bars and titles around a plot, for the charts and waterfalls of sonars.
// unit is the size in pixels that all lettering is a multiple of: 1 for a panel about 900 px high.
// Pure functions; any thread. Pixels, y down.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/draw2d/canvas.hpp"
#include "engine/draw2d/color_maps.hpp"

namespace neritic::draw2d {

inline constexpr Color kPlotBackground{0.035f, 0.042f, 0.052f};
inline constexpr Color kPlotText{0.80f, 0.87f, 0.90f};
inline constexpr Color kPlotLine{0.62f, 0.80f, 0.86f};

struct PlotBox {
  double left = 0, top = 0, right = 0, bottom = 0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

// 1, 2 or 5 times a power of ten, so that span has about count steps. CHECKs that both are
// positive.
double nice_step(double span, double count);
// Multiples of nice_step in [from, to] (either order). Empty if the span is not positive and
// finite.
std::vector<double> nice_ticks(double from, double to, double count);
// The largest 1, 2 or 5 times a power of ten that is at most value; value > 0.
double nice_at_most(double value);
// "12.5": seven digits, without the noise of binary fractions, with a true minus sign, never "−0".
std::string number_text(double value);

// Ticks with numbers left of the box, from its top to its bottom, and faint lines across.
void draw_left_axis(Canvas& canvas, const PlotBox& box, double at_top, double at_bottom,
                    const std::string& label, double unit);
// The same below the box, from its left to its right.
void draw_bottom_axis(Canvas& canvas, const PlotBox& box, double at_left, double at_right,
                      const std::string& label, double unit);
void draw_frame(Canvas& canvas, const PlotBox& box, double unit);

// A vertical bar of a map's colours, the map's 0 at the bottom, with numbers at its right.
void draw_legend(Canvas& canvas, const PlotBox& bar, ColorMap map, double at_bottom, double at_top,
                 const std::string& label, double unit);
// The same with given marks, at 0 (bottom) to 1 (top).
struct LegendMark {
  double at;
  std::string text;
};
void draw_legend(Canvas& canvas, const PlotBox& bar, ColorMap map,
                 std::span<const LegendMark> marks, const std::string& label, double unit);

// A bar of a round length in metres, at most max_px long, its left end at (x, y).
void draw_scale_bar(Canvas& canvas, double x, double y, double px_per_m, double max_px,
                    double unit);
// The title and the line under it, at the upper left; cut with "…" at the right edge.
void draw_title(Canvas& canvas, const std::string& title, const std::string& subtitle, double unit);

}  // namespace neritic::draw2d
