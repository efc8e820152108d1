#include "sonar/panel_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/draw2d/axes.hpp"

namespace neritic::sonar {

using namespace draw2d;

namespace {

constexpr std::array<double, 5> kScaleMarks{0.0, 0.25, 0.5, 0.75, 1.0};

std::string range_text(double metres) {
  return metres >= 1000.0 ? number_text(std::round(metres) / 1000.0) + " km"
                          : number_text(std::round(metres * 1000.0) / 1000.0) + " m";
}

struct Margins {
  double top, bottom, left, right;  // multiples of the unit
};
constexpr Margins kWithWords{106, 66, 64, 118}, kWithoutWords{24, 24, 24, 24};
constexpr double kBearingsBelow = 26;  // added to the bottom margin if bearings stand there

// The colour scale lies in the upper right corner, which no fan reaches.
struct ScaleBox {
  double left, right, top, bottom;
};
ScaleBox scale_box(const Canvas& canvas, double unit) {
  const double right = canvas.width() - 26 * unit;
  return {right - 12 * unit, right, 30 * unit, 210 * unit};
}

// Whether text that ends at (right, y) would meet the colour scale or its numbers.
bool meets_scale(const Canvas& canvas, double unit, double right, double y) {
  const ScaleBox box = scale_box(canvas, unit);
  return right > box.left - 60 * unit && y < box.bottom + 20 * unit;
}

bool is_full_turn(const Limits& l) {
  return l.azimuth_max_rad - l.azimuth_min_rad > radians(350.0);
}

}  // namespace

PanelLayout lay_out(const BeamGrid& grid, std::uint32_t height_px, bool words) {
  Margins margins = words ? kWithWords : kWithoutWords;
  const Limits& l = grid.limits;
  // The lowest bearing of a full turn stands in the middle, clear of the lines of text.
  if (words && !is_full_turn(l) && std::max(-l.azimuth_min_rad, l.azimuth_max_rad) > kPi / 2.0)
    margins.bottom += kBearingsBelow;
  // The bounds of the fan for a radius of 1, bearings clockwise from up.
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
               l.azimuth_max_rad, width, kPlotLine.with_alpha(alpha));
  };
  const bool full_turn = is_full_turn(l);
  const double step = nice_step(l.range_max_m, 5.0);
  // A label stands outside the fan beside the starboard edge, or beside the port edge if it would
  // meet the colour scale.
  const auto label = [&](double range_m) {
    if (!words) return;
    const std::string text = range_text(range_m);
    const double size = 10.5 * unit, off = 11.0 * unit, width = canvas.text_width(size, text);
    for (const double side : {1.0, -1.0}) {
      const double edge = full_turn ? 0.0 : side > 0.0 ? l.azimuth_max_rad : -l.azimuth_min_rad;
      // An edge past abeam has its outer side towards the middle.
      const bool outboard = std::cos(edge) >= 0.0;
      const double push =
          outboard ? std::max(0.35, std::cos(edge)) : std::min(-0.35, std::cos(edge));
      const double x =
          layout.apex_x + side * (range_m * layout.scale * std::sin(edge) + off * push);
      const double y =
          layout.apex_y - range_m * layout.scale * std::cos(edge) + off * std::sin(edge);
      const bool rightwards = outboard == (side > 0.0);
      if (side > 0.0 && meets_scale(canvas, unit, rightwards ? x + width : x, y)) continue;
      canvas.text(x, y, size, text, kPlotText.with_alpha(0.85f),
                  rightwards ? Align::kLeft : Align::kRight, Face::kRegular,
                  VerticalAlign::kMiddle);
      return;
    }
  };
  for (double r = step; r < l.range_max_m - 0.35 * step; r += step)
    if (r > l.range_min_m) {
      ring(r, 0.32f, 1.0 * unit);
      label(r);
    }
  if (l.range_min_m > 0.0) {
    ring(l.range_min_m, 0.45f, 1.2 * unit);
    if (l.range_min_m > 0.06 * l.range_max_m) label(l.range_min_m);
  }
  ring(l.range_max_m, 0.55f, 1.4 * unit);
  if (!full_turn)
    label(l.range_max_m);  // on a full circle it would lie on the arc; the title states it
}

void draw_bearings(Canvas& canvas, const PanelLayout& layout, const Limits& l, double unit,
                   bool words) {
  const auto line = [&](double bearing, float alpha, double width) {
    const double s = std::sin(bearing) * layout.scale, c = -std::cos(bearing) * layout.scale;
    canvas.segment(layout.apex_x + l.range_min_m * s, layout.apex_y + l.range_min_m * c,
                   layout.apex_x + l.range_max_m * s, layout.apex_y + l.range_max_m * c, width,
                   kPlotLine.with_alpha(alpha));
  };
  const double span = degrees(l.azimuth_max_rad - l.azimuth_min_rad);
  // The least distance of two numbers, so that those of a narrow fan do not meet.
  constexpr double kApart = 46.0;
  const double least = degrees(kApart * unit / (l.range_max_m * layout.scale));
  const double step = span > 200.0  ? 30.0
                      : span > 50.0 ? 15.0
                      : words       ? nice_step(std::max(span / 6.0, least), 1.0)
                                    : nice_step(span, 6.0);
  for (double b = std::ceil(degrees(l.azimuth_min_rad) / step - 1e-6) * step;
       b <= degrees(l.azimuth_max_rad) + 1e-6; b += step) {
    if (span > 359.0 && b < -179.0) continue;  // the same line as +180
    line(radians(b), 0.22f, 1.0 * unit);
    const double out = l.range_max_m * layout.scale;
    const double a = radians(b);
    canvas.segment(layout.apex_x + out * std::sin(a), layout.apex_y - out * std::cos(a),
                   layout.apex_x + (out + 6 * unit) * std::sin(a),
                   layout.apex_y - (out + 6 * unit) * std::cos(a), 1.2 * unit,
                   kPlotLine.with_alpha(0.6f));
    if (!words) continue;
    const double size = 10.5 * unit;
    const std::string text = number_text(b) + "\u00b0";
    // Far enough out that the text's box clears the tick on any side of the fan.
    const double far = out + 10 * unit +
                       std::abs(std::sin(a)) * canvas.text_width(size, text) / 2.0 +
                       std::abs(std::cos(a)) * size / 2.0;
    canvas.text(layout.apex_x + far * std::sin(a), layout.apex_y - far * std::cos(a), size, text,
                kPlotText.with_alpha(0.85f), Align::kCenter, Face::kRegular,
                VerticalAlign::kMiddle);
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
                          map_color(ColorMap::kCopper, (i + 0.5) / 180.0));
  for (const double part : kScaleMarks) {
    const double y = box.bottom - part * (box.bottom - box.top);
    canvas.segment(box.left - 5 * unit, y, box.left - unit, y, 1.2 * unit,
                   kPlotText.with_alpha(0.8f));
  }
}

void draw_gain(Canvas& canvas, double full_scale, const PanelOptions& options) {
  const double unit = options.height_px / 900.0;
  const ScaleBox box = scale_box(canvas, unit);
  const bool decibels = options.span_db > 0.0;
  const double full_db = 10.0 * std::log10(full_scale);
  for (const double part : kScaleMarks)
    canvas.text(box.left - 9 * unit, box.bottom - part * (box.bottom - box.top), 9 * unit,
                decibels ? number_text(std::round(full_db - (1.0 - part) * options.span_db))
                         : fmt::format("{:.3g}", full_scale * std::pow(part, 1.0 / options.gamma)),
                kPlotText.with_alpha(0.85f), Align::kRight, Face::kRegular, VerticalAlign::kMiddle);
  canvas.text(canvas.width() - 26 * unit, 20 * unit, 9 * unit,
              decibels ? "dB re 1 \u00b5Pa" : "mean cosine", kPlotText.with_alpha(0.85f),
              Align::kRight);
  const char* gain = options.full_scale > 0.0 ? "fixed" : "auto gain,";
  canvas.text(24 * unit, canvas.height() - 15 * unit, 10.5 * unit,
              decibels ? fmt::format("display: {} full scale {:.0f} dB, {:g} dB below it shown",
                                     gain, full_db, options.span_db)
                       : fmt::format("display: {} full scale {:.3g}, gamma {:g}", gain, full_scale,
                                     options.gamma),
              kPlotText.with_alpha(0.65f));
}

void draw_words(Canvas& canvas, const BeamGrid& grid, const std::string& title, double unit) {
  const Limits& l = grid.limits;
  const auto aperture = [](double from, double to) {
    return std::round(degrees(to - from) * 100) / 100;
  };
  // A title that would meet the numbers of the colour scale is set smaller, then cut.
  const double room = scale_box(canvas, unit).left - 88 * unit;
  const double size = std::clamp(
      17 * unit * room / canvas.text_width(17 * unit, title, Face::kBold), 11 * unit, 17 * unit);
  canvas.text(24 * unit, 38 * unit, size, canvas.shortened(size, title, room, Face::kBold),
              kPlotText, Align::kLeft, Face::kBold);
  canvas.text(24 * unit, 62 * unit, 10.5 * unit,
              fmt::format("range {} to {}   aperture {:g}\u00b0 \u00d7 {:g}\u00b0",
                          range_text(l.range_min_m), range_text(l.range_max_m),
                          aperture(l.azimuth_min_rad, l.azimuth_max_rad),
                          aperture(l.elevation_min_rad, l.elevation_max_rad)),
              kPlotText.with_alpha(0.8f));
  canvas.text(24 * unit, canvas.height() - 34 * unit, 10.5 * unit,
              fmt::format("bins {} range, {} azimuth, {} elevation", grid.bins.range,
                          grid.bins.azimuth, grid.bins.elevation),
              kPlotText.with_alpha(0.65f));
}

}  // namespace neritic::sonar
