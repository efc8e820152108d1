#include "sonar/trace_panel.hpp"

#include <algorithm>
#include <cmath>

#include "sonar/panel_drawing.hpp"
#include "sonar/waterfall_panel.hpp"

namespace neritic::sonar {
namespace {

constexpr int kMarks = 5;  // parts of either axis

}  // namespace

ImageU8 draw_trace(const BeamGrid& grid, std::span<const float> intensity,
                   const PanelOptions& options) {
  const double unit = options.height_px / 900.0;
  const auto width = static_cast<std::uint32_t>(1200 * unit),
             height = static_cast<std::uint32_t>(480 * unit);
  Canvas canvas(width, height, kPanelBackground);
  const SonarImage image{grid.bins.range, 1, {intensity.begin(), intensity.end()}, {}};
  // A curve is shown to its peak.
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
    canvas.text(left - 8 * unit, y + 4 * unit, 10 * unit,
                options.span_db > 0.0 ? fmt::format("{:.0f} dB", 10.0 * std::log10(full) -
                                                                     (1.0 - part) * options.span_db)
                                      : fmt::format("{:.3g}", full * part),
                kPlotText.with_alpha(0.85f), Align::kRight);
  }
  canvas.text(left, top - 12 * unit, 10 * unit,
              options.span_db > 0.0 ? "dB re 1 uPa" : "mean cosine", kPlotText.with_alpha(0.7f));
  PanelOptions linear = options;
  linear.gamma = 1.0;
  double last_x = left, last_y = bottom;
  for (std::size_t i = 0; i < intensity.size(); ++i) {
    const double x = left + (i + 0.5) / static_cast<double>(intensity.size()) * (right - left);
    const double y = bottom - panel_brightness(intensity[i], full, linear) * (bottom - top);
    canvas.segment(last_x, last_y, x, y, 1.6 * unit, panel_color(0.75));
    last_x = x;
    last_y = y;
  }
  return canvas.take();
}

}  // namespace neritic::sonar
