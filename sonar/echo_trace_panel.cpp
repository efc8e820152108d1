// The range-time picture of an echo trace. Pure functions; any thread.
#include <algorithm>
#include <cmath>

#include "engine/draw2d/axes.hpp"
#include "engine/draw2d/resample.hpp"
#include "sonar/echo_trace.hpp"

namespace neritic::sonar {

using namespace draw2d;

namespace {

// [range][ping] as 0 to 1 over the span_db decibels below the strongest echo, on the box's pixels.
// Averages power, then converts to decibels, as a display with fewer lines than pings does.
ImageF32 shades_of(const EchoTrace& trace, double strongest, double span_db, std::uint32_t width,
                   std::uint32_t height) {
  const std::size_t pings = trace.pings().size(), bins = trace.options().n_range;
  std::vector<float> turned(pings * bins);
  for (std::size_t p = 0; p < pings; ++p)
    for (std::size_t r = 0; r < bins; ++r) turned[r * pings + p] = trace.intensity()[p * bins + r];
  ImageF32 out = resample_area(turned, bins, pings, width, height);
  for (float& v : out.data) {
    const double db = 10.0 * std::log10(std::max(double{v} / strongest, 1e-30));
    v = static_cast<float>(std::clamp(1.0 + db / span_db, 0.0, 1.0));
  }
  return out;
}

// The first return of each ping; the line is broken where pings have none.
void draw_line(Canvas& canvas, const PlotBox& box, const EchoTrace& trace, double unit) {
  const auto& pings = trace.pings();
  const EchoTraceOptions& o = trace.options();
  const auto x = [&](std::size_t i) {
    return box.left +
           (static_cast<double>(i) + 0.5) / static_cast<double>(pings.size()) * box.width();
  };
  const auto y = [&](std::size_t i) {
    return box.top +
           (pings[i].first_m - o.range_min_m) / (o.range_max_m - o.range_min_m) * box.height();
  };
  const Color white{1, 1, 1, 0.9f};
  std::vector<Vec2> line;
  for (std::size_t i = 0; i <= pings.size(); ++i) {
    if (i < pings.size() && !std::isnan(pings[i].first_m)) {
      line.emplace_back(x(i), y(i));
      continue;
    }
    canvas.polyline(line, 1.3 * unit, white);
    line.clear();
  }
}

std::string time_label(const EchoTrace& trace, double from_s, double to_s) {
  return fmt::format("time, s   ({} pings, {} to {} s)", trace.pings().size(),
                     number_text(std::round(10.0 * from_s) / 10.0),
                     number_text(std::round(10.0 * to_s) / 10.0));
}

}  // namespace

ImageU8 draw_echo_trace(const EchoTrace& trace, const EchoPictureOptions& options) {
  const double unit = options.height_px / 900.0;
  Canvas canvas(options.width_px, options.height_px, kPlotBackground);
  const EchoTraceOptions& o = trace.options();
  const PlotBox box{std::round(84 * unit), std::round(92 * unit),
                    std::round(options.width_px - 120 * unit),
                    std::round(options.height_px - 66 * unit)};
  draw_title(canvas, options.title,
             fmt::format("range {} to {} m in {} bins   white: first return",
                         number_text(o.range_min_m), number_text(o.range_max_m), o.n_range),
             unit);
  const auto& pings = trace.pings();
  double strongest = 0.0;
  for (const float v : trace.intensity()) strongest = std::max(strongest, double{v});
  if (!pings.empty() && box.width() >= 1.0 && box.height() >= 1.0) {
    draw_shades(canvas, static_cast<int>(box.left), static_cast<int>(box.top),
                shades_of(trace, strongest > 0.0 ? strongest : 1.0, options.span_db,
                          static_cast<std::uint32_t>(box.width()),
                          static_cast<std::uint32_t>(box.height())),
                ColorMap::kEcho);
    draw_line(canvas, box, trace, unit);
    const double from = pings.front().time_s, to = pings.back().time_s;
    draw_bottom_axis(canvas, box, from, to, time_label(trace, from, to), unit);
  }
  draw_left_axis(canvas, box, o.range_min_m, o.range_max_m, "range, m", unit);
  draw_frame(canvas, box, unit);
  const double bar = options.width_px - 78 * unit;
  draw_legend(canvas, {bar, box.top, bar + 14 * unit, box.top + 260 * unit}, ColorMap::kEcho,
              -options.span_db, 0.0, "dB re max", unit);
  return canvas.take();
}

}  // namespace neritic::sonar
