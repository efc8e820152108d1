#include "engine/draw2d/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"

namespace neritic::draw2d {

double nice_step(double span, double count) {
  NERITIC_CHECK(span > 0.0 && count > 0.0, "a span of {} in {} steps", span, count);
  const double raw = span / count, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= raw * 0.999) return m * power;
  return 10.0 * power;
}

std::vector<double> nice_ticks(double from, double to, double count) {
  const double low = std::min(from, to), high = std::max(from, to);
  std::vector<double> ticks;
  if (!(high - low > 0.0) || !std::isfinite(high - low)) return ticks;
  const double step = nice_step(high - low, count);
  const double first = std::ceil(low / step - 1e-9);
  // Far from zero a step can be smaller than the spacing of doubles: then there is nothing to mark.
  for (int i = 0; i < 1000 && (first + i) * step <= high + 1e-9 * step; ++i) {
    const double tick = (first + i) * step;
    if (!ticks.empty() && !(tick > ticks.back())) break;
    ticks.push_back(tick == 0.0 ? 0.0 : tick);
  }
  return ticks;
}

double nice_at_most(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double m : {5.0, 2.0})
    if (m * power <= value * 1.0000001) return m * power;
  return power;
}

std::string number_text(double value) {
  const double rounded = std::abs(value) < 1e9 ? std::round(value * 1e6) / 1e6 : value;
  const std::string digits = fmt::format("{:.7g}", std::abs(rounded));
  return rounded < 0.0 ? "\u2212" + digits : digits;
}

void draw_left_axis(Canvas& canvas, const PlotBox& box, double at_top, double at_bottom,
                    const std::string& label, double unit) {
  for (const double tick : nice_ticks(at_top, at_bottom, box.height() / (70.0 * unit))) {
    const double y = box.top + (tick - at_top) / (at_bottom - at_top) * box.height();
    canvas.segment(box.left - 5 * unit, y, box.left - unit, y, 1.2 * unit,
                   kPlotText.with_alpha(0.8f));
    canvas.segment(box.left, y, box.right, y, unit, kPlotLine.with_alpha(0.13f));
    canvas.text(box.left - 9 * unit, y, 9 * unit, number_text(tick), kPlotText.with_alpha(0.85f),
                Align::kRight, Face::kRegular, VerticalAlign::kMiddle);
  }
  canvas.text(box.left, box.top - 9 * unit, 9 * unit, label, kPlotText.with_alpha(0.7f),
              Align::kRight);
}

void draw_bottom_axis(Canvas& canvas, const PlotBox& box, double at_left, double at_right,
                      const std::string& label, double unit) {
  for (const double tick : nice_ticks(at_left, at_right, box.width() / (110.0 * unit))) {
    const double x = box.left + (tick - at_left) / (at_right - at_left) * box.width();
    canvas.segment(x, box.bottom + unit, x, box.bottom + 5 * unit, 1.2 * unit,
                   kPlotText.with_alpha(0.8f));
    canvas.segment(x, box.top, x, box.bottom, unit, kPlotLine.with_alpha(0.10f));
    canvas.text(x, box.bottom + 19 * unit, 9 * unit, number_text(tick), kPlotText.with_alpha(0.85f),
                Align::kCenter);
  }
  canvas.text((box.left + box.right) / 2.0, box.bottom + 37 * unit, 9.5 * unit, label,
              kPlotText.with_alpha(0.7f), Align::kCenter);
}

void draw_frame(Canvas& canvas, const PlotBox& box, double unit) {
  const Color line = kPlotLine.with_alpha(0.5f);
  canvas.segment(box.left, box.top, box.right, box.top, 1.2 * unit, line);
  canvas.segment(box.right, box.top, box.right, box.bottom, 1.2 * unit, line);
  canvas.segment(box.right, box.bottom, box.left, box.bottom, 1.2 * unit, line);
  canvas.segment(box.left, box.bottom, box.left, box.top, 1.2 * unit, line);
}

void draw_legend(Canvas& canvas, const PlotBox& bar, ColorMap map, double at_bottom, double at_top,
                 const std::string& label, double unit) {
  std::vector<LegendMark> marks;
  for (const double tick : nice_ticks(at_bottom, at_top, bar.height() / (42.0 * unit)))
    marks.push_back({(tick - at_bottom) / (at_top - at_bottom), number_text(tick)});
  draw_legend(canvas, bar, map, marks, label, unit);
}

void draw_legend(Canvas& canvas, const PlotBox& bar, ColorMap map,
                 std::span<const LegendMark> marks, const std::string& label, double unit) {
  const int steps = std::max(1, static_cast<int>(bar.height()));
  for (int i = 0; i < steps; ++i)
    canvas.fill_rectangle(bar.left, bar.bottom - (i + 1) * bar.height() / steps, bar.right,
                          bar.bottom - i * bar.height() / steps, map_color(map, (i + 0.5) / steps));
  for (const LegendMark& mark : marks) {
    const double y = bar.bottom - mark.at * bar.height();
    canvas.segment(bar.right + unit, y, bar.right + 5 * unit, y, 1.2 * unit,
                   kPlotText.with_alpha(0.8f));
    canvas.text(bar.right + 9 * unit, y, 9 * unit, mark.text, kPlotText.with_alpha(0.85f),
                Align::kLeft, Face::kRegular, VerticalAlign::kMiddle);
  }
  canvas.text(bar.left, bar.top - 14 * unit, 9 * unit, label, kPlotText.with_alpha(0.7f));
}

void draw_scale_bar(Canvas& canvas, double x, double y, double px_per_m, double max_px,
                    double unit) {
  const double length_m = nice_at_most(max_px / px_per_m), end = x + length_m * px_per_m;
  const std::string text = number_text(length_m) + " m";
  canvas.fill_rectangle(x - 7 * unit, y - 11 * unit,
                        end + canvas.text_width(10 * unit, text) + 18 * unit, y + 11 * unit,
                        Color{0, 0, 0, 0.55f});
  canvas.segment(x, y, end, y, 2.2 * unit, kPlotText);
  for (const double at : {x, end})
    canvas.segment(at, y - 4 * unit, at, y + 4 * unit, 1.6 * unit, kPlotText);
  canvas.text(end + 9 * unit, y, 10 * unit, text, kPlotText, Align::kLeft, Face::kRegular,
              VerticalAlign::kMiddle);
}

void draw_title(Canvas& canvas, const std::string& title, const std::string& subtitle,
                double unit) {
  const double left = 24 * unit, room = canvas.width() - 2.0 * left;
  canvas.text(left, 34 * unit, 16 * unit, canvas.shortened(16 * unit, title, room, Face::kBold),
              kPlotText, Align::kLeft, Face::kBold);
  canvas.text(left, 57 * unit, 10 * unit, canvas.shortened(10 * unit, subtitle, room),
              kPlotText.with_alpha(0.8f));
}

}  // namespace neritic::draw2d
