#include "sonar/waterfall_panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/core/check.hpp"

namespace neritic::sonar {
namespace {

constexpr std::array<Color, 6> kBronze{{{0.02f, 0.012f, 0.006f},
                                        {0.22f, 0.11f, 0.035f},
                                        {0.50f, 0.28f, 0.08f},
                                        {0.80f, 0.52f, 0.17f},
                                        {0.97f, 0.80f, 0.42f},
                                        {1.0f, 0.97f, 0.85f}}};
constexpr std::array<Color, 7> kEcho{{{0.015f, 0.025f, 0.075f},
                                      {0.05f, 0.13f, 0.42f},
                                      {0.06f, 0.47f, 0.72f},
                                      {0.10f, 0.68f, 0.36f},
                                      {0.94f, 0.87f, 0.18f},
                                      {0.93f, 0.36f, 0.10f},
                                      {0.62f, 0.05f, 0.09f}}};
constexpr std::array<Color, 7> kDepth{{{0.27f, 0.12f, 0.45f},
                                       {0.15f, 0.28f, 0.68f},
                                       {0.14f, 0.58f, 0.78f},
                                       {0.30f, 0.76f, 0.56f},
                                       {0.80f, 0.85f, 0.36f},
                                       {0.96f, 0.64f, 0.26f},
                                       {0.80f, 0.24f, 0.18f}}};

std::span<const Color> stops_of(Palette palette) {
  switch (palette) {
    case Palette::kBronze:
      return kBronze;
    case Palette::kEcho:
      return kEcho;
    case Palette::kDepth:
      return kDepth;
  }
  return kBronze;
}

// Source cells that [at, at + 1) * step covers, and how much of the first and last.
struct Cover {
  std::size_t first, last;
  double from, to;
  double weight(std::size_t i) const {
    return std::min(to, static_cast<double>(i + 1)) - std::max(from, static_cast<double>(i));
  }
};
Cover cover(std::uint32_t at, std::uint32_t pixels, std::size_t cells) {
  const double step = static_cast<double>(cells) / pixels;
  const double from = at * step, to = at + 1 == pixels ? static_cast<double>(cells) : from + step;
  const auto first = std::min(static_cast<std::size_t>(from), cells - 1);
  const auto end = static_cast<std::size_t>(std::ceil(to));
  return {first, std::clamp(end, first + 1, cells) - 1, from, to};
}

double tick_step(double span, double count) {
  const double raw = span / count, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= raw * 0.999) return m * power;
  return 10.0 * power;
}

}  // namespace

Color palette_color(Palette palette, double value) {
  const auto stops = stops_of(palette);
  const double held = value > 0.0 ? std::min(value, 1.0) : 0.0;
  const double at = held * static_cast<double>(stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  return mix(stops[i], stops[i + 1], static_cast<float>(at - static_cast<double>(i)));
}

std::vector<double> nice_ticks(double from, double to, double count) {
  const double low = std::min(from, to), high = std::max(from, to);
  std::vector<double> ticks;
  if (!(high - low > 0.0) || !std::isfinite(high - low)) return ticks;
  const double step = tick_step(high - low, count);
  const double first = std::ceil(low / step - 1e-9);
  // Far from zero a step may lie below the numbers' own spacing: then there is nothing to mark.
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
  return fmt::format("{:.7g}", rounded == 0.0 ? 0.0 : rounded);
}

ImageF32 resample_area(std::span<const float> values, std::size_t rows, std::size_t columns,
                       std::uint32_t width, std::uint32_t height) {
  NERITIC_CHECK(
      values.size() == rows * columns && rows > 0 && columns > 0 && width > 0 && height > 0,
      "{} values for {} x {}, to {} x {} pixels", values.size(), rows, columns, height, width);
  ImageF32 out(width, height, 1);
  std::vector<Cover> across;
  for (std::uint32_t x = 0; x < width; ++x) across.push_back(cover(x, width, columns));
  for (std::uint32_t y = 0; y < height; ++y) {
    const Cover down = cover(y, height, rows);
    for (std::uint32_t x = 0; x < width; ++x) {
      double sum = 0.0, weight = 0.0;
      for (std::size_t r = down.first; r <= down.last; ++r)
        for (std::size_t c = across[x].first; c <= across[x].last; ++c) {
          const float v = values[r * columns + c];
          if (std::isnan(v)) continue;
          const double w = down.weight(r) * across[x].weight(c);
          sum += w * v;
          weight += w;
        }
      out.at(x, y) =
          weight > 0.0 ? static_cast<float>(sum / weight) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return out;
}

double percentile_of_heard(std::span<const float> values, double fraction) {
  std::vector<float> heard;
  for (const float v : values)
    if (v > 0.0f && std::isfinite(v)) heard.push_back(v);
  if (heard.empty()) return 1.0;
  const auto at =
      heard.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(heard.size() - 1));
  std::nth_element(heard.begin(), at, heard.end());
  return *at;
}

void draw_shades(Canvas& canvas, const PlotBox& box, const ImageF32& shades, Palette palette) {
  const int left = static_cast<int>(std::lround(box.left)),
            top = static_cast<int>(std::lround(box.top));
  for (std::uint32_t y = 0; y < shades.height; ++y)
    for (std::uint32_t x = 0; x < shades.width; ++x)
      if (const float v = shades.at(x, y); !std::isnan(v))
        canvas.blend(left + static_cast<int>(x), top + static_cast<int>(y),
                     palette_color(palette, v), 1.0f);
}

void draw_left_axis(Canvas& canvas, const PlotBox& box, double at_top, double at_bottom,
                    const std::string& label, double unit) {
  for (const double tick : nice_ticks(at_top, at_bottom, box.height() / (70.0 * unit))) {
    const double y = box.top + (tick - at_top) / (at_bottom - at_top) * box.height();
    canvas.segment(box.left - 5 * unit, y, box.left - unit, y, 1.2 * unit,
                   kPlotText.with_alpha(0.8f));
    canvas.segment(box.left, y, box.right, y, unit, kPlotLine.with_alpha(0.13f));
    canvas.text(box.left - 9 * unit, y + 4 * unit, 9 * unit, number_text(tick),
                kPlotText.with_alpha(0.85f), Align::kRight);
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

void draw_legend(Canvas& canvas, const PlotBox& bar, Palette palette, double at_bottom,
                 double at_top, const std::string& label, double unit) {
  std::vector<LegendMark> marks;
  for (const double tick : nice_ticks(at_bottom, at_top, bar.height() / (42.0 * unit)))
    marks.push_back({(tick - at_bottom) / (at_top - at_bottom), number_text(tick)});
  draw_legend(canvas, bar, palette, marks, label, unit);
}

void draw_legend(Canvas& canvas, const PlotBox& bar, Palette palette,
                 std::span<const LegendMark> marks, const std::string& label, double unit) {
  const int steps = std::max(1, static_cast<int>(bar.height()));
  for (int i = 0; i < steps; ++i)
    canvas.fill_rectangle(bar.left, bar.bottom - (i + 1) * bar.height() / steps, bar.right,
                          bar.bottom - i * bar.height() / steps,
                          palette_color(palette, (i + 0.5) / steps));
  for (const LegendMark& mark : marks) {
    const double y = bar.bottom - mark.at * bar.height();
    canvas.segment(bar.right + unit, y, bar.right + 5 * unit, y, 1.2 * unit,
                   kPlotText.with_alpha(0.8f));
    canvas.text(bar.right + 12 * unit, y + 4 * unit, 9 * unit, mark.text,
                kPlotText.with_alpha(0.85f));
  }
  canvas.text(bar.left, bar.top - 14 * unit, 9 * unit, label, kPlotText.with_alpha(0.7f));
}

void draw_scale_bar(Canvas& canvas, double x, double y, double px_per_m, double max_px,
                    double unit) {
  const double length_m = nice_at_most(max_px / px_per_m), end = x + length_m * px_per_m;
  const std::string text = number_text(length_m) + " m";
  canvas.fill_rectangle(x - 7 * unit, y - 11 * unit,
                        end + Canvas::text_width(10 * unit, text) + 18 * unit, y + 11 * unit,
                        Color{0, 0, 0, 0.55f});
  canvas.segment(x, y, end, y, 2.2 * unit, kPlotText);
  for (const double at : {x, end})
    canvas.segment(at, y - 4 * unit, at, y + 4 * unit, 1.6 * unit, kPlotText);
  canvas.text(end + 9 * unit, y + 4 * unit, 10 * unit, text, kPlotText);
}

void draw_title(Canvas& canvas, const std::string& title, const std::string& subtitle,
                double unit) {
  canvas.text(24 * unit, 34 * unit, 16 * unit, title, kPlotText, Align::kLeft, 2.1 * unit);
  canvas.text(24 * unit, 57 * unit, 10 * unit, subtitle, kPlotText.with_alpha(0.8f));
}

}  // namespace neritic::sonar
