#include "sonar/trace_panel.hpp"

#include <algorithm>
#include <cmath>

#include "engine/draw2d/axes.hpp"
#include "sonar/panel_drawing.hpp"

namespace neritic::sonar {

using namespace draw2d;

ImageU8 draw_trace(const BeamGrid& grid, std::span<const float> intensity,
                   const PanelOptions& options) {
  const double unit = options.height_px / 900.0;
  const auto width = static_cast<std::uint32_t>(1200 * unit),
             height = static_cast<std::uint32_t>(480 * unit);
  Canvas canvas(width, height, kPlotBackground);
  const SonarImage image{grid.bins.range, 1, {intensity.begin(), intensity.end()}, {}};
  // The automatic full scale of a curve is its peak.
  PanelOptions whole = options;
  if (!(whole.full_scale > 0.0) && !intensity.empty())
    whole.full_scale = *std::max_element(intensity.begin(), intensity.end());
  const double full = panel_full_scale(image, whole);
  const PlotBox box{90 * unit, 104 * unit, width - 40 * unit, height - 92 * unit};
  draw_words(canvas, grid, options.title, unit);
  const double full_db = 10.0 * std::log10(full);
  if (options.span_db > 0.0)
    draw_left_axis(canvas, box, full_db, full_db - options.span_db, "dB re 1 \u00b5Pa", unit);
  else
    draw_left_axis(canvas, box, full, 0.0, "mean cosine", unit);
  draw_bottom_axis(canvas, box, grid.limits.range_min_m, grid.limits.range_max_m, "range, m", unit);
  draw_frame(canvas, box, unit);
  PanelOptions linear = options;
  linear.gamma = 1.0;
  std::vector<Vec2> curve{{box.left, box.bottom}};
  for (std::size_t i = 0; i < intensity.size(); ++i) {
    const double x = box.left + (i + 0.5) / static_cast<double>(intensity.size()) * box.width();
    const double y = box.bottom - panel_brightness(intensity[i], full, linear) * box.height();
    curve.emplace_back(x, y);
  }
  canvas.polyline(curve, 1.6 * unit, map_color(ColorMap::kCopper, 0.75));
  return canvas.take();
}

}  // namespace neritic::sonar
