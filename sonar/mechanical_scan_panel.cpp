// The map of a mechanical scan. Pure functions; any thread.
#include <algorithm>
#include <cmath>

#include "engine/draw2d/axes.hpp"
#include "engine/draw2d/resample.hpp"
#include "sonar/levels.hpp"
#include "sonar/mechanical_scan.hpp"
#include "sonar/panel.hpp"

namespace neritic::sonar {

using namespace draw2d;

namespace {

constexpr double kGamma = 0.6, kScanTop = 96, kScanBottom = 64, kScanLeft = 84, kScanRight = 110;

void draw_track(Canvas& canvas, const PlotBox& box, const MechanicalScan& scan,
                const ScanMosaic& mosaic, double px_per_m, double unit) {
  const Vec2 corner(static_cast<double>(mosaic.first_column) * mosaic.cell_m,
                    static_cast<double>(mosaic.first_row) * mosaic.cell_m);
  const auto pixel = [&](const ScanStep& step) {
    const Vec3& p = step.world_from_sonar.position_m;
    return Vec2(box.left, box.top) + (Vec2(p.x, p.z) - corner) * px_per_m;
  };
  const auto& steps = scan.steps();
  const Color blue{0.45f, 0.85f, 1.0f, 0.9f};
  std::vector<Vec2> line;
  for (const ScanStep& step : steps) line.push_back(pixel(step));
  canvas.polyline(line, 1.6 * unit, blue);
  canvas.disc(line.back().x, line.back().y, 3.5 * unit, blue);
}

}  // namespace

ImageU8 draw_mosaic(const MechanicalScan& scan, const ScanMosaic& mosaic, const std::string& title,
                    std::uint32_t height_px) {
  const double unit = height_px / 900.0;
  const double columns = std::max(1u, mosaic.columns), rows = std::max(1u, mosaic.rows);
  const double room = height_px - (kScanTop + kScanBottom) * unit;
  const double px_per_cell = std::min(room / rows, 2.0 * room / columns);
  const double wide = std::max(1.0, std::round(columns * px_per_cell)),
               high = std::max(1.0, std::round(rows * px_per_cell));
  Canvas canvas(static_cast<std::uint32_t>(
                    std::lround(std::max(wide, 420.0 * unit) + (kScanLeft + kScanRight) * unit)),
                height_px, kPlotBackground);
  const double left = std::round(kScanLeft * unit), top = std::round(kScanTop * unit);
  const PlotBox box{left, top, left + wide, top + high};
  const double full_scale = percentile_of_heard(mosaic.intensity, 0.995);
  const bool levels = scan.options().levels;
  draw_title(canvas, title,
             fmt::format("{} steps   cells of {} m   {}   blue: track", scan.steps().size(),
                         number_text(mosaic.cell_m),
                         levels ? "power re 1 \u00b5Pa"
                                : fmt::format("full scale {:.3g}, gamma {:g}", full_scale, kGamma)),
             unit);
  if (!mosaic.intensity.empty()) {
    ImageF32 shades =
        resample_area(mosaic.intensity, mosaic.rows, mosaic.columns,
                      static_cast<std::uint32_t>(wide), static_cast<std::uint32_t>(high));
    const PanelOptions display{.gamma = kGamma, .span_db = levels ? kScanShown_db : 0.0};
    for (float& v : shades.data)
      if (!std::isnan(v)) v = static_cast<float>(panel_brightness(v, full_scale, display));
    draw_shades(canvas, static_cast<int>(left), static_cast<int>(top), shades, ColorMap::kBronze);
    const double west = static_cast<double>(mosaic.first_column) * mosaic.cell_m,
                 north = static_cast<double>(mosaic.first_row) * mosaic.cell_m;
    draw_left_axis(canvas, box, north, north + rows * mosaic.cell_m, "z, m", unit);
    draw_bottom_axis(canvas, box, west, west + columns * mosaic.cell_m, "x, m (north is up)", unit);
    draw_track(canvas, box, scan, mosaic, px_per_cell / mosaic.cell_m, unit);
    draw_scale_bar(canvas, box.left + 14 * unit, box.bottom - 18 * unit,
                   px_per_cell / mosaic.cell_m, 0.25 * wide, unit);
  }
  draw_frame(canvas, box, unit);
  const double bar = canvas.width() - 82 * unit;
  const double top_db = 10.0 * std::log10(full_scale);
  draw_legend(canvas, {bar, top, bar + 14 * unit, top + 220 * unit}, ColorMap::kBronze,
              levels ? top_db - kScanShown_db : 0.0, levels ? top_db : 100.0,
              levels ? "dB" : "display, %", unit);
  return canvas.take();
}

}  // namespace neritic::sonar
