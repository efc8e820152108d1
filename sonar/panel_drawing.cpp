#include "sonar/panel_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace neritic::sonar {
namespace {

constexpr Color kLine{0.62f, 0.80f, 0.86f};
constexpr Color kText{0.80f, 0.87f, 0.90f};
constexpr std::array<double, 5> kScaleMarks{0.0, 0.25, 0.5, 0.75, 1.0};

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

struct Margins {
  double top, bottom, left, right;  // in 900 px of height
};
constexpr Margins kWithWords{106, 66, 64, 118}, kWithoutWords{24, 24, 24, 24};
constexpr double kBearingsBelow = 26;  // more at the bottom, where a sector's bearings end there

// The colour scale lies in a corner that no fan reaches.
struct ScaleBox {
  double left, right, top, bottom;
};
ScaleBox scale_box(const Canvas& canvas, double unit) {
  const double right = canvas.width() - 26 * unit;
  return {right - 12 * unit, right, 30 * unit, 210 * unit};
}

// Where the colour scale and its numbers are.
bool meets_scale(const Canvas& canvas, double unit, double right, double y) {
  const ScaleBox box = scale_box(canvas, unit);
  return right > box.left - 60 * unit && y < box.bottom + 20 * unit;
}

bool is_full_turn(const Limits& l) {
  return l.azimuth_max_rad - l.azimuth_min_rad > radians(350.0);
}

}  // namespace

Color panel_color(double value) {
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

PanelLayout lay_out(const BeamGrid& grid, std::uint32_t height_px, bool words) {
  Margins margins = words ? kWithWords : kWithoutWords;
  const Limits& l = grid.limits;
  // Of a full turn the lowest number stands in the middle, clear of the lines of text.
  if (words && !is_full_turn(l) && std::max(-l.azimuth_min_rad, l.azimuth_max_rad) > kPi / 2.0)
    margins.bottom += kBearingsBelow;
  // The fan's box for a radius of 1, bearings clockwise from up.
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (int i = 0; i <= 513; ++i) {
    const double a = glm::mix(l.azimuth_min_rad, l.azimuth_max_rad, (i / 2) / 256.0);
    const double r = i % 2 == 0 ? 1.0 : l.range_min_m / l.range_max_m;
    left = std::min(left, r * std::sin(a));
    right = std::max(right, r * std::sin(a));
    top = std::min(top, -r * std::cos(a));
    bottom = std::max(bottom, -r * std::cos(a));
  }
  const double unit = height_px / 900.0;
  const double room = height_px - (margins.top + margins.bottom) * unit;
  double radius = room / (bottom - top);
  const double width = std::clamp((right - left) * radius + (margins.left + margins.right) * unit,
                                  720.0 * unit, 1500.0 * unit);
  const double room_x = width - (margins.left + margins.right) * unit;
  radius = std::min(radius, room_x / std::max(right - left, 1e-9));
  return {static_cast<std::uint32_t>(std::lround(width)), height_px,
          margins.left * unit + room_x / 2.0 - (left + right) / 2.0 * radius,
          margins.top * unit + room / 2.0 - (top + bottom) / 2.0 * radius, radius / l.range_max_m};
}

void draw_rings(Canvas& canvas, const PanelLayout& layout, const Limits& l, double unit,
                bool words) {
  const auto ring = [&](double range_m, float alpha, double width) {
    canvas.arc(layout.apex_x, layout.apex_y, range_m * layout.scale, l.azimuth_min_rad,
               l.azimuth_max_rad, width, kLine.with_alpha(alpha));
  };
  const bool full_turn = is_full_turn(l);
  const double step = nice_step(l.range_max_m, 5.0);
  // Beside the starboard edge, a little off along the edge's normal, away from the fan; beside the
  // port edge where the colour scale is.
  const auto label = [&](double range_m) {
    if (!words) return;
    const std::string text = range_text(range_m);
    const double size = 10.5 * unit, off = 11.0 * unit, width = canvas.text_width(size, text);
    for (const double side : {1.0, -1.0}) {
      const double edge = full_turn ? 0.0 : side > 0.0 ? l.azimuth_max_rad : -l.azimuth_min_rad;
      // Past abeam the outside is inboard.
      const bool outboard = std::cos(edge) >= 0.0;
      const double push =
          outboard ? std::max(0.35, std::cos(edge)) : std::min(-0.35, std::cos(edge));
      const double x =
          layout.apex_x + side * (range_m * layout.scale * std::sin(edge) + off * push);
      const double y = layout.apex_y - range_m * layout.scale * std::cos(edge) +
                       off * std::sin(edge) + 4.0 * unit;
      const bool rightwards = outboard == (side > 0.0);
      if (side > 0.0 && meets_scale(canvas, unit, rightwards ? x + width : x, y)) continue;
      canvas.text(x, y, size, text, kText.with_alpha(0.85f),
                  rightwards ? Align::kLeft : Align::kRight);
      return;
    }
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

void draw_bearings(Canvas& canvas, const PanelLayout& layout, const Limits& l, double unit,
                   bool words) {
  const auto line = [&](double bearing, float alpha, double width) {
    const double s = std::sin(bearing) * layout.scale, c = -std::cos(bearing) * layout.scale;
    canvas.segment(layout.apex_x + l.range_min_m * s, layout.apex_y + l.range_min_m * c,
                   layout.apex_x + l.range_max_m * s, layout.apex_y + l.range_max_m * c, width,
                   kLine.with_alpha(alpha));
  };
  const double span = degrees(l.azimuth_max_rad - l.azimuth_min_rad);
  // Numbers of a narrow fan would meet.
  constexpr double kApart = 46.0;
  const double least = degrees(kApart * unit / (l.range_max_m * layout.scale));
  const double step = span > 200.0  ? 30.0
                      : span > 50.0 ? 15.0
                      : words       ? nice_step(std::max(span / 6.0, least), 1.0)
                                    : nice_step(span, 6.0);
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
    if (!words) continue;
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

void draw_scale(Canvas& canvas, double unit) {
  const ScaleBox box = scale_box(canvas, unit);
  for (int i = 0; i < 180; ++i)
    canvas.fill_rectangle(box.left, box.bottom - (i + 1) * unit, box.right, box.bottom - i * unit,
                          panel_color((i + 0.5) / 180.0));
  for (const double part : kScaleMarks) {
    const double y = box.bottom - part * (box.bottom - box.top);
    canvas.segment(box.left - 5 * unit, y, box.left - unit, y, 1.2 * unit, kText.with_alpha(0.8f));
  }
}

void draw_gain(Canvas& canvas, double full_scale, const PanelOptions& options) {
  const double unit = options.height_px / 900.0;
  const ScaleBox box = scale_box(canvas, unit);
  const bool decibels = options.span_db > 0.0;
  const double full_db = 10.0 * std::log10(full_scale);
  for (const double part : kScaleMarks)
    canvas.text(box.left - 9 * unit, box.bottom - part * (box.bottom - box.top) + 4 * unit,
                9 * unit,
                decibels ? fmt::format("{:.0f} dB", full_db - (1.0 - part) * options.span_db)
                         : fmt::format("{:.3g}", full_scale * std::pow(part, 1.0 / options.gamma)),
                kText.with_alpha(0.85f), Align::kRight);
  const char* gain = options.full_scale > 0.0 ? "fixed" : "auto gain,";
  canvas.text(24 * unit, canvas.height() - 15 * unit, 10.5 * unit,
              decibels ? fmt::format("display: {} full scale {:.0f} dB, {:g} dB below it shown",
                                     gain, full_db, options.span_db)
                       : fmt::format("display: {} full scale {:.3g}, gamma {:g}", gain, full_scale,
                                     options.gamma),
              kText.with_alpha(0.65f));
}

void draw_words(Canvas& canvas, const BeamGrid& grid, const std::string& title, double unit) {
  const Limits& l = grid.limits;
  const auto aperture = [](double from, double to) {
    return std::round(degrees(to - from) * 100) / 100;
  };
  canvas.text(24 * unit, 38 * unit, 17 * unit, title, kText, Align::kLeft, 2.2 * unit);
  canvas.text(24 * unit, 62 * unit, 10.5 * unit,
              fmt::format("range {} to {}   aperture {:g}\u00b0 \u00d7 {:g}\u00b0",
                          range_text(l.range_min_m), range_text(l.range_max_m),
                          aperture(l.azimuth_min_rad, l.azimuth_max_rad),
                          aperture(l.elevation_min_rad, l.elevation_max_rad)),
              kText.with_alpha(0.8f));
  canvas.text(24 * unit, canvas.height() - 34 * unit, 10.5 * unit,
              fmt::format("bins {} range, {} azimuth, {} elevation", grid.bins.range,
                          grid.bins.azimuth, grid.bins.elevation),
              kText.with_alpha(0.65f));
}

}  // namespace neritic::sonar
