// The chart of a bathymetric grid. Pure functions; any thread.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/draw2d/axes.hpp"
#include "engine/draw2d/resample.hpp"
#include "sonar/bathymetry.hpp"

namespace neritic::sonar {

using namespace draw2d;

namespace {

constexpr double kTop = 92, kBottom = 70, kLeft = 84,
                 kRight = 150;  // margins, multiples of the unit

struct DepthSpan {
  double shallow = 0.0, deep = 1.0;
};
// The middle 99 % of the depths, so that a stray sounding does not stretch the colours.
DepthSpan span_of(const BathymetryGrid& grid) {
  std::vector<double> depths;
  for (const double d : grid.mean_m)
    if (!std::isnan(d)) depths.push_back(d);
  if (depths.empty()) return {};
  const auto at = [&](double part) {
    const auto it =
        depths.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(depths.size() - 1));
    std::nth_element(depths.begin(), it, depths.end());
    return *it;
  };
  DepthSpan span{at(0.005), at(0.995)};
  if (span.deep - span.shallow < 1e-3) span = {span.shallow - 5e-4, span.shallow + 5e-4};
  return span;
}

double depth_at(const BathymetryGrid& grid, std::int64_t column, std::int64_t row) {
  if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows)
    return std::numeric_limits<double>::quiet_NaN();
  return grid
      .mean_m[static_cast<std::size_t>(row) * grid.columns + static_cast<std::size_t>(column)];
}

// Rise per metre towards greater indices; one-sided at an edge or a hole, 0 for a lone cell.
double rise(double before, double here, double after, double cell_m) {
  if (!std::isnan(before) && !std::isnan(after)) return (before - after) / (2.0 * cell_m);
  if (!std::isnan(after)) return (here - after) / cell_m;
  if (!std::isnan(before)) return (before - here) / cell_m;
  return 0.0;
}

struct Slope {
  double east, south;
};
Slope slope_at(const BathymetryGrid& grid, std::int64_t c, std::int64_t r) {
  const double here = depth_at(grid, c, r);
  return {rise(depth_at(grid, c - 1, r), here, depth_at(grid, c + 1, r), grid.cell_m),
          rise(depth_at(grid, c, r - 1), here, depth_at(grid, c, r + 1), grid.cell_m)};
}

// The factor by which heights are exaggerated, so that the 90th percentile of the slopes is shaded
// like one of 30 degrees.
double exaggeration(const BathymetryGrid& grid) {
  std::vector<double> slopes;
  for (std::uint32_t r = 0; r < grid.rows; ++r)
    for (std::uint32_t c = 0; c < grid.columns; ++c)
      if (!std::isnan(depth_at(grid, c, r))) {
        const Slope s = slope_at(grid, c, r);
        slopes.push_back(std::hypot(s.east, s.south));
      }
  if (slopes.empty()) return 1.0;
  const auto at = slopes.begin() + static_cast<std::ptrdiff_t>(0.9 * (slopes.size() - 1.0));
  std::nth_element(slopes.begin(), at, slopes.end());
  return *at > 0.0 ? std::clamp(std::tan(radians(30.0)) / *at, 1.0, 50.0) : 1.0;
}

// Lambert's cosine under a light in the north-west, 45 degrees high, relative to level ground.
double shade_at(const Slope& slope, double exaggerate) {
  const Vec3 normal =
      glm::normalize(Vec3(-slope.east * exaggerate, 1.0, -slope.south * exaggerate));
  const Vec3 light = glm::normalize(Vec3(-1.0, std::sqrt(2.0), -1.0));
  return std::max(0.0, glm::dot(normal, light)) / light.y;
}

Color lit(const Color& c, double shade) {
  const auto s = static_cast<float>(std::clamp(0.35 + 0.65 * shade, 0.0, 1.35));
  const auto channel = [&](float v) { return std::min(1.0f, v * s); };
  return {channel(c.r), channel(c.g), channel(c.b)};
}

void draw_cells(Canvas& canvas, const PlotBox& box, const BathymetryGrid& grid,
                const DepthSpan& span) {
  const double exaggerate = exaggeration(grid);
  std::vector<Color> colors(grid.cells());
  for (std::size_t i = 0; i < colors.size(); ++i)
    if (!std::isnan(grid.mean_m[i]))
      colors[i] = lit(
          map_color(ColorMap::kDepth, (span.deep - grid.mean_m[i]) / (span.deep - span.shallow)),
          shade_at(slope_at(grid, static_cast<std::int64_t>(i % grid.columns),
                            static_cast<std::int64_t>(i / grid.columns)),
                   exaggerate));
  // Resamples each channel by itself; holes stay holes.
  const auto width = static_cast<std::uint32_t>(std::lround(box.width())),
             height = static_cast<std::uint32_t>(std::lround(box.height()));
  std::array<ImageF32, 3> planes;
  for (int k = 0; k < 3; ++k) {
    std::vector<float> plane(colors.size());
    for (std::size_t i = 0; i < plane.size(); ++i)
      plane[i] = std::isnan(grid.mean_m[i]) ? std::numeric_limits<float>::quiet_NaN()
                 : k == 0                   ? colors[i].r
                 : k == 1                   ? colors[i].g
                                            : colors[i].b;
    planes[static_cast<std::size_t>(k)] =
        resample_area(plane, grid.rows, grid.columns, width, height);
  }
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      if (!std::isnan(planes[0].at(x, y)))
        canvas.blend(static_cast<int>(box.left) + static_cast<int>(x),
                     static_cast<int>(box.top) + static_cast<int>(y),
                     {planes[0].at(x, y), planes[1].at(x, y), planes[2].at(x, y)}, 1.0f);
}

}  // namespace

ImageU8 draw_bathymetry(const BathymetryGrid& grid, const std::string& title,
                        std::uint32_t height_px) {
  const double unit = height_px / 900.0;
  const double columns = std::max(1u, grid.columns), rows = std::max(1u, grid.rows);
  const double room = height_px - (kTop + kBottom) * unit;
  // As high as the panel allows, but at most twice as wide as that.
  const double px_per_cell = std::min(room / rows, 2.0 * room / columns);
  const double wide = std::max(1.0, std::round(columns * px_per_cell)),
               high = std::max(1.0, std::round(rows * px_per_cell));
  const double width = std::max(wide, 420.0 * unit) + (kLeft + kRight) * unit;
  // The legend needs a least height.
  const double height = std::max(high, 280.0 * unit) + (kTop + kBottom) * unit;
  Canvas canvas(static_cast<std::uint32_t>(std::lround(width)),
                static_cast<std::uint32_t>(std::lround(height)), kPlotBackground);
  const DepthSpan span = span_of(grid);
  draw_title(canvas, title,
             fmt::format("{} \u00d7 {} cells of {} m   light from the north-west", grid.rows,
                         grid.columns, number_text(grid.cell_m)),
             unit);
  const double left = std::round(kLeft * unit), top = std::round(kTop * unit);
  const PlotBox box{left, top, left + wide, top + high};
  if (grid.cells() > 0) {
    draw_cells(canvas, box, grid, span);
    draw_left_axis(canvas, box, grid.north_m(), grid.north_m() + rows * grid.cell_m, "z, m", unit);
    draw_bottom_axis(canvas, box, grid.west_m(), grid.west_m() + columns * grid.cell_m,
                     "x, m (north is up)", unit);
    draw_scale_bar(canvas, box.left + 14 * unit, box.bottom - 16 * unit, px_per_cell / grid.cell_m,
                   0.3 * wide, unit);
  }
  draw_frame(canvas, box, unit);
  const double bar = width - (kRight - 34) * unit;
  draw_legend(canvas, {bar, top, bar + 14 * unit, top + 260 * unit}, ColorMap::kDepth, span.deep,
              span.shallow, "depth, m", unit);
  return canvas.take();
}

}  // namespace neritic::sonar
