#include "sonar/panel.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/draw2d/axes.hpp"
#include "sonar/levels.hpp"
#include "sonar/panel_drawing.hpp"

namespace neritic::sonar {

using namespace draw2d;

namespace {

constexpr std::uint32_t kOutside = ~0u;
constexpr int kLevels = 1024;  // of brightness

// The colour of each brightness level, as bytes.
std::vector<std::array<std::uint16_t, 3>> level_colors() {
  std::vector<std::array<std::uint16_t, 3>> out;
  const auto byte = [](float v) { return static_cast<std::uint16_t>(v * 255.0f + 0.5f); };
  for (int i = 0; i < kLevels; ++i) {
    const Color c = map_color(ColorMap::kCopper, i / (kLevels - 1.0));
    out.push_back({byte(c.r), byte(c.g), byte(c.b)});
  }
  return out;
}

}  // namespace

double panel_brightness(double value, double full_scale, const PanelOptions& options) {
  const double part = value / full_scale;
  if (!(part > 0.0)) return 0.0;
  const double shown = options.span_db > 0.0 ? 1.0 + 10.0 * std::log10(part) / options.span_db
                                             : std::pow(part, options.gamma);
  return std::clamp(shown, 0.0, 1.0);
}

double panel_full_scale(const SonarImage& image, const PanelOptions& options) {
  return options.full_scale > 0.0 ? options.full_scale
                                  : percentile_of_heard(image.intensity, 0.995);
}

PolarPanel::PolarPanel(const BeamGrid& grid, const PanelOptions& options)
    : grid_(grid), options_(options) {
  const PanelLayout layout = lay_out(grid, options.height_px, options.words);
  const double unit = options.height_px / 900.0;
  Canvas under(layout.width, layout.height, kPlotBackground);
  if (options.words) {
    draw_scale(under, unit);
    draw_words(under, grid, options.title, unit);
  }
  under_ = under.take();
  const auto lines = [&](const Color& ground) {
    Canvas canvas(layout.width, layout.height, ground);
    draw_rings(canvas, layout, grid.limits, unit, options.words);
    draw_bearings(canvas, layout, grid.limits, unit, options.words);
    return canvas.take();
  };
  lines_over_black_ = lines({0, 0, 0});
  lines_over_white_ = lines({1, 1, 1});
  for (std::uint32_t pixel = 0; pixel < layout.width * layout.height; ++pixel) {
    Fan fan{pixel, {}};
    for (std::size_t k = 0; k < fan.cells.size(); ++k) {
      // Four samples, no two of which share a row or column of the pixel (a rotated grid).
      constexpr double kX[] = {0.375, 0.875, 0.125, 0.625}, kY[] = {0.125, 0.375, 0.625, 0.875};
      fan.cells[k] = cell_at((pixel % layout.width + kX[k] - layout.apex_x) / layout.scale,
                             (pixel / layout.width + kY[k] - layout.apex_y) / layout.scale);
    }
    if (std::any_of(fan.cells.begin(), fan.cells.end(), [](auto cell) { return cell != kOutside; }))
      fan_.push_back(fan);
  }
}

// The cell at a place given in metres right of and below the apex.
std::uint32_t PolarPanel::cell_at(double right_m, double below_m) const {
  const Limits& l = grid_.limits;
  const double r2 = right_m * right_m + below_m * below_m;
  if (r2 < l.range_min_m * l.range_min_m || r2 >= l.range_max_m * l.range_max_m) return kOutside;
  const double turn = (l.azimuth_min_rad + l.azimuth_max_rad) / 2.0;
  const double bearing = turn + std::remainder(std::atan2(right_m, -below_m) - turn, 2.0 * kPi);
  const auto row = bin_index(std::sqrt(r2), l.range_min_m, l.range_max_m, grid_.bins.range);
  const auto column = bin_index(bearing, l.azimuth_min_rad, l.azimuth_max_rad, grid_.bins.azimuth);
  return row && column ? *row * grid_.bins.azimuth + *column : kOutside;
}

ImageU8 PolarPanel::draw(const SonarImage& image) const {
  NERITIC_CHECK(image.intensity.size() == std::size_t{grid_.bins.range} * grid_.bins.azimuth,
                "{} values for {} x {} bins", image.intensity.size(), grid_.bins.range,
                grid_.bins.azimuth);
  const double full_scale = panel_full_scale(image, options_);
  Canvas canvas(under_);
  if (options_.words) draw_gain(canvas, full_scale, options_);
  ImageU8 out = canvas.take();

  const auto colors = level_colors();
  std::vector<std::uint16_t> levels(image.intensity.size());
  for (std::size_t i = 0; i < levels.size(); ++i)
    levels[i] = static_cast<std::uint16_t>(
        panel_brightness(image.intensity[i], full_scale, options_) * (kLevels - 1) + 0.5);
  for (const Fan& fan : fan_) {
    std::uint8_t* p = &out.data[3 * std::size_t{fan.pixel}];
    unsigned sum[3] = {};
    for (const std::uint32_t cell : fan.cells)
      for (int k = 0; k < 3; ++k) sum[k] += cell == kOutside ? p[k] : colors[levels[cell]][k];
    for (int k = 0; k < 3; ++k) p[k] = static_cast<std::uint8_t>((sum[k] + 2) / 4);
  }
  // Blending is linear: the lines over black and over white give the lines over any colour.
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    const int black = lines_over_black_.data[i], white = lines_over_white_.data[i];
    if (white - black < 255)
      out.data[i] = static_cast<std::uint8_t>(black + (out.data[i] * (white - black) + 127) / 255);
  }
  return out;
}

ImageU8 draw_panel(const BeamGrid& grid, const SonarImage& image, const PanelOptions& options) {
  return PolarPanel(grid, options).draw(image);
}

}  // namespace neritic::sonar
