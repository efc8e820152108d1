#include "sonar/panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/check.hpp"
#include "sonar/canvas.hpp"

namespace neritic::sonar {
namespace {

constexpr Color kBackground{0.035f, 0.042f, 0.052f};
constexpr Color kLine{0.62f, 0.80f, 0.86f};
constexpr Color kText{0.80f, 0.87f, 0.90f};

// Copper: black, umber, copper, amber, cream.
Color color_map(double value) {
  static constexpr std::array<Color, 6> kStops{{{0.055f, 0.035f, 0.022f},
                                                {0.30f, 0.125f, 0.045f},
                                                {0.62f, 0.285f, 0.075f},
                                                {0.89f, 0.52f, 0.16f},
                                                {0.99f, 0.80f, 0.42f},
                                                {1.0f, 0.975f, 0.88f}}};
  const double at = std::clamp(value, 0.0, 1.0) * (kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  return mix(kStops[i], kStops[i + 1], static_cast<float>(at - static_cast<double>(i)));
}

// 1, 2 or 5 times a power of ten, so that span holds about count of them.
double nice_step(double span, double count) {
  const double raw = span / count, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= raw * 0.999) return m * power;
  return 10.0 * power;
}

std::string range_text(double metres) {
  return metres >= 1000.0 ? fmt::format("{:g} km", std::round(metres) / 1000.0)
                          : fmt::format("{:g} m", std::round(metres * 1000.0) / 1000.0);
}

// Where the fan lies: apex in pixels, pixels a metre.
struct Layout {
  std::uint32_t width, height;
  double apex_x, apex_y, scale;
};

constexpr double kTop = 106, kBottom = 66, kLeft = 64, kRight = 118;  // margins in 900 px of height

Layout lay_out(const BeamGrid& grid, const PanelOptions& options) {
  const Limits& l = grid.limits;
  // The fan's box for a radius of 1, bearings clockwise from up.
  double left = 0, right = 0, top = 0, bottom = 0;
  for (int i = 0; i <= 256; ++i) {
    const double a = glm::mix(l.azimuth_min_rad, l.azimuth_max_rad, i / 256.0);
    left = std::min(left, std::sin(a));
    right = std::max(right, std::sin(a));
    top = std::min(top, -std::cos(a));
    bottom = std::max(bottom, -std::cos(a));
  }
  const double unit = options.height_px / 900.0;
  const double room = options.height_px - (kTop + kBottom) * unit;
  double radius = room / (bottom - top);
  const double width =
      std::clamp((right - left) * radius + (kLeft + kRight) * unit, 720.0 * unit, 1500.0 * unit);
  const double room_x = width - (kLeft + kRight) * unit;
  radius = std::min(radius, room_x / std::max(right - left, 1e-9));
  return {static_cast<std::uint32_t>(std::lround(width)), options.height_px,
          kLeft * unit + room_x / 2.0 - (left + right) / 2.0 * radius,
          kTop * unit + room / 2.0 - (top + bottom) / 2.0 * radius, radius / l.range_max_m};
}

void draw_returns(Canvas& canvas, const Layout& layout, const BeamGrid& grid,
                  const SonarImage& image, double full_scale, double gamma) {
  const Limits& l = grid.limits;
  constexpr int kSamples =
      3;  // a side of a pixel: smooth edges, and thin beams near the apex blend
  const double turn = (l.azimuth_min_rad + l.azimuth_max_rad) / 2.0;
  const auto first_y =
      static_cast<std::uint32_t>(std::max(0.0, layout.apex_y - l.range_max_m * layout.scale - 1));
  const auto last_y = static_cast<std::uint32_t>(
      std::clamp(layout.apex_y + l.range_max_m * layout.scale + 1, 0.0, double(layout.height)));
  for (std::uint32_t y = first_y; y < last_y; ++y)
    for (std::uint32_t x = 0; x < layout.width; ++x) {
      Color sum{0, 0, 0, 0};
      int inside = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const double px = (x + (k % kSamples + 0.5) / kSamples - layout.apex_x) / layout.scale;
        const double py = (y + (k / kSamples + 0.5) / kSamples - layout.apex_y) / layout.scale;
        const double r2 = px * px + py * py;
        if (r2 < l.range_min_m * l.range_min_m || r2 >= l.range_max_m * l.range_max_m) continue;
        const double bearing = turn + std::remainder(std::atan2(px, -py) - turn, 2.0 * kPi);
        const auto row = bin_index(std::sqrt(r2), l.range_min_m, l.range_max_m, grid.bins.range);
        const auto column =
            bin_index(bearing, l.azimuth_min_rad, l.azimuth_max_rad, grid.bins.azimuth);
        if (!row || !column) continue;
        const float value = image.intensity[std::size_t{*row} * grid.bins.azimuth + *column];
        const Color c = color_map(std::pow(std::max(0.0, value / full_scale), gamma));
        sum = {sum.r + c.r, sum.g + c.g, sum.b + c.b, 1};
        ++inside;
      }
      if (inside == 0) continue;
      const auto n = static_cast<float>(inside);
      canvas.blend(static_cast<int>(x), static_cast<int>(y), {sum.r / n, sum.g / n, sum.b / n, 1},
                   n / (kSamples * kSamples));
    }
}

void draw_rings(Canvas& canvas, const Layout& layout, const Limits& l, double unit) {
  const auto ring = [&](double range_m, float alpha, double width) {
    canvas.arc(layout.apex_x, layout.apex_y, range_m * layout.scale, l.azimuth_min_rad,
               l.azimuth_max_rad, width, kLine.with_alpha(alpha));
  };
  const bool full_turn = l.azimuth_max_rad - l.azimuth_min_rad > radians(350.0);
  const double step = nice_step(l.range_max_m, 5.0);
  const double edge = full_turn ? 0.0 : l.azimuth_max_rad;
  const auto label = [&](double range_m) {
    const double x = layout.apex_x + range_m * layout.scale * std::sin(edge);
    const double y = layout.apex_y - range_m * layout.scale * std::cos(edge);
    // Beside the starboard edge, a little off along the edge's normal.
    const double off = 11.0 * unit;
    canvas.text(x + off * std::max(0.35, std::cos(edge)), y + off * std::sin(edge) + 4.0 * unit,
                10.5 * unit, range_text(range_m), kText.with_alpha(0.85f));
  };
  for (double r = step; r < l.range_max_m - 0.35 * step; r += step)
    if (r > l.range_min_m) {
      ring(r, 0.20f, 1.0 * unit);
      label(r);
    }
  if (l.range_min_m > 0.0) {
    ring(l.range_min_m, 0.45f, 1.2 * unit);
    if (l.range_min_m > 0.06 * l.range_max_m) label(l.range_min_m);
  }
  ring(l.range_max_m, 0.55f, 1.4 * unit);
  if (!full_turn)
    label(l.range_max_m);  // on a full circle it would lie on the arc; the title has it
}

void draw_bearings(Canvas& canvas, const Layout& layout, const Limits& l, double unit) {
  const auto line = [&](double bearing, float alpha, double width) {
    const double s = std::sin(bearing) * layout.scale, c = -std::cos(bearing) * layout.scale;
    canvas.segment(layout.apex_x + l.range_min_m * s, layout.apex_y + l.range_min_m * c,
                   layout.apex_x + l.range_max_m * s, layout.apex_y + l.range_max_m * c, width,
                   kLine.with_alpha(alpha));
  };
  const double span = degrees(l.azimuth_max_rad - l.azimuth_min_rad);
  const double step = span > 200.0 ? 30.0 : span > 50.0 ? 15.0 : nice_step(span, 6.0);
  for (double b = std::ceil(degrees(l.azimuth_min_rad) / step - 1e-6) * step;
       b <= degrees(l.azimuth_max_rad) + 1e-6; b += step) {
    if (span > 359.0 && b < -179.0) continue;  // the same line as +180
    line(radians(b), 0.16f, 1.0 * unit);
    const double out = l.range_max_m * layout.scale;
    const double a = radians(b);
    canvas.segment(layout.apex_x + out * std::sin(a), layout.apex_y - out * std::cos(a),
                   layout.apex_x + (out + 6 * unit) * std::sin(a),
                   layout.apex_y - (out + 6 * unit) * std::cos(a), 1.2 * unit,
                   kLine.with_alpha(0.6f));
    const double far = out + 22 * unit;
    const double rounded = std::abs(b) < 1e-9 ? 0.0 : b;
    canvas.text(layout.apex_x + far * std::sin(a), layout.apex_y - far * std::cos(a) + 5 * unit,
                10.5 * unit, fmt::format("{:g}\u00b0", rounded), kText.with_alpha(0.85f),
                Align::kCenter);
  }
  if (span < 359.0) {
    line(l.azimuth_min_rad, 0.5f, 1.4 * unit);
    line(l.azimuth_max_rad, 0.5f, 1.4 * unit);
  }
}

void draw_scale(Canvas& canvas, double full_scale, double gamma, double unit) {
  const double right = canvas.width() - 26 * unit,
               left = right - 12 * unit;  // a corner no fan reaches
  const double top = 30 * unit, bottom = top + 180 * unit;
  for (int i = 0; i < 180; ++i)
    canvas.fill_rectangle(left, bottom - (i + 1) * unit, right, bottom - i * unit,
                          color_map((i + 0.5) / 180.0));
  for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double y = bottom - part * (bottom - top);
    canvas.segment(left - 5 * unit, y, left - 1 * unit, y, 1.2 * unit, kText.with_alpha(0.8f));
    canvas.text(left - 9 * unit, y + 4 * unit, 9 * unit,
                fmt::format("{:.3g}", full_scale * std::pow(part, 1.0 / gamma)),
                kText.with_alpha(0.85f), Align::kRight);
  }
}

void draw_words(Canvas& canvas, const BeamGrid& grid, const PanelOptions& options,
                double full_scale, double unit) {
  const Limits& l = grid.limits;
  canvas.text(24 * unit, 38 * unit, 17 * unit, options.title, kText, Align::kLeft, 2.2 * unit);
  canvas.text(
      24 * unit, 62 * unit, 10.5 * unit,
      fmt::format("range {} to {}   aperture {:g}\u00b0 \u00d7 {:g}\u00b0",
                  range_text(l.range_min_m), range_text(l.range_max_m),
                  std::round(degrees(l.azimuth_max_rad - l.azimuth_min_rad) * 100) / 100,
                  std::round(degrees(l.elevation_max_rad - l.elevation_min_rad) * 100) / 100),
      kText.with_alpha(0.8f));
  canvas.text(24 * unit, canvas.height() - 34 * unit, 10.5 * unit,
              fmt::format("bins {} range, {} azimuth, {} elevation", grid.bins.range,
                          grid.bins.azimuth, grid.bins.elevation),
              kText.with_alpha(0.65f));
  canvas.text(
      24 * unit, canvas.height() - 15 * unit, 10.5 * unit,
      fmt::format("display: {} full scale {:.3g}, gamma {:g}",
                  options.full_scale > 0.0 ? "fixed" : "auto gain,", full_scale, options.gamma),
      kText.with_alpha(0.65f));
}

}  // namespace

double panel_full_scale(const SonarImage& image, const PanelOptions& options) {
  if (options.full_scale > 0.0) return options.full_scale;
  std::vector<float> heard;
  for (const float value : image.intensity)
    if (value > 0.0f) heard.push_back(value);
  if (heard.empty()) return 1.0;
  const auto at =
      heard.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(heard.size() - 1));
  std::nth_element(heard.begin(), at, heard.end());
  return *at;
}

ImageU8 draw_panel(const BeamGrid& grid, const SonarImage& image, const PanelOptions& options) {
  NERITIC_CHECK(image.intensity.size() == std::size_t{grid.bins.range} * grid.bins.azimuth,
                "{} values for {} x {} bins", image.intensity.size(), grid.bins.range,
                grid.bins.azimuth);
  const Layout layout = lay_out(grid, options);
  const double unit = options.height_px / 900.0;
  const double full_scale = panel_full_scale(image, options);
  Canvas canvas(layout.width, layout.height, kBackground);
  draw_returns(canvas, layout, grid, image, full_scale, options.gamma);
  draw_rings(canvas, layout, grid.limits, unit);
  draw_bearings(canvas, layout, grid.limits, unit);
  draw_scale(canvas, full_scale, options.gamma, unit);
  draw_words(canvas, grid, options, full_scale, unit);
  return canvas.take();
}

}  // namespace neritic::sonar
