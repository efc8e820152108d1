#include "sonar/trace_panel.hpp"

#include <algorithm>
#include <cmath>

#include "engine/draw2d/axes.hpp"
#include "sonar/panel_drawing.hpp"

namespace neritic::sonar {

using namespace draw2d;

namespace {

constexpr int kMarks = 5;  // parts that each axis is divided into

}  // namespace

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
  const double left = 90 * unit, right = width - 40 * unit, top = 90 * unit,
               bottom = height - 84 * unit;
  draw_words(canvas, grid, options.title, unit);
  for (int i = 0; i <= kMarks; ++i) {
    const double part = double(i) / kMarks;
    const double x = left + part * (right - left), y = bottom - part * (bottom - top);
    canvas.segment(x, top, x, bottom, unit, kPlotLine.with_alpha(0.14f));
    canvas.segment(left, y, right, y, unit, kPlotLine.with_alpha(0.14f));
    const Limits& l = grid.limits;
    canvas.text(x, bottom + 20 * unit, 10 * unit,
                fmt::format("{:.4g} m", l.range_min_m + part * (l.range_max_m - l.range_min_m)),
                kPlotText.with_alpha(0.85f), Align::kCenter);
    canvas.text(left - 8 * unit, y, 10 * unit,
                options.span_db > 0.0 ? fmt::format("{:.0f} dB", 10.0 * std::log10(full) -
                                                                     (1.0 - part) * options.span_db)
                                      : fmt::format("{:.3g}", full * part),
                kPlotText.with_alpha(0.85f), Align::kRight, Face::kRegular, VerticalAlign::kMiddle);
  }
  canvas.text(left, top - 12 * unit, 10 * unit,
              options.span_db > 0.0 ? "dB re 1 \u00b5Pa" : "mean cosine",
              kPlotText.with_alpha(0.7f));
  PanelOptions linear = options;
  linear.gamma = 1.0;
  std::vector<Vec2> curve{{left, bottom}};
  for (std::size_t i = 0; i < intensity.size(); ++i) {
    const double x = left + (i + 0.5) / static_cast<double>(intensity.size()) * (right - left);
    const double y = bottom - panel_brightness(intensity[i], full, linear) * (bottom - top);
    curve.emplace_back(x, y);
  }
  canvas.polyline(curve, 1.6 * unit, map_color(ColorMap::kCopper, 0.75));
  return canvas.take();
}

}  // namespace neritic::sonar
