#include "sonar/terrain_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace neritic::sonar {
namespace {

constexpr double kNoTerrain = std::numeric_limits<double>::quiet_NaN();

// errors is reordered.
TerrainError summary(std::vector<double>& errors) {
  TerrainError out;
  out.count = errors.size();
  if (errors.empty()) {
    out.rms_m = out.mean_m = out.p95_m = out.max_m = kNoTerrain;
    return out;
  }
  const double n = static_cast<double>(errors.size());
  double sum = 0.0, squares = 0.0;
  for (double& e : errors) {
    sum += e;
    squares += e * e;
    e = std::abs(e);
  }
  out.mean_m = sum / n;
  out.rms_m = std::sqrt(squares / n);
  // The smallest bound that at least 95 % keep.
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * n)) - 1;
  const auto at = errors.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(errors.begin(), at, errors.end());
  out.p95_m = *at;
  out.max_m = *std::max_element(at, errors.end());
  return out;
}

// Height of the mesh between four samples, at s (east) and t (south) in [0, 1] of their cell. The
// diagonal runs south-west to north-east; where one of its ends is missing, the other.
double height_in(const std::array<double, 4>& nw_ne_sw_se, double s, double t) {
  const auto [nw, ne, sw, se] = nw_ne_sw_se;
  if (!std::isnan(sw) && !std::isnan(ne)) {
    if (s + t <= 1.0) return nw + s * (ne - nw) + t * (sw - nw);
    return se + (1.0 - s) * (sw - se) + (1.0 - t) * (ne - se);
  }
  if (t >= s) return nw + t * (sw - nw) + s * (se - sw);
  return nw + s * (ne - nw) + t * (se - ne);
}

}  // namespace

TrueDepth true_depth(std::shared_ptr<const scene::Heightfield> field, const Vec3& position_m) {
  return [field = std::move(field), position_m](double x_m, double z_m) {
    const double column = (x_m - position_m.x) / field->cell_m + 0.5 * (field->columns - 1.0),
                 row = (z_m - position_m.z) / field->cell_m + 0.5 * (field->rows - 1.0);
    if (!(column >= 0.0 && row >= 0.0 && column <= field->columns - 1.0 &&
          row <= field->rows - 1.0))
      return kNoTerrain;
    const auto c = std::min(static_cast<std::size_t>(column), std::size_t{field->columns} - 2),
               r = std::min(static_cast<std::size_t>(row), std::size_t{field->rows} - 2);
    const auto height = [&](std::size_t dc, std::size_t dr) {
      return static_cast<double>(field->heights_m[(r + dr) * field->columns + c + dc]);
    };
    return -(position_m.y + height_in({height(0, 0), height(1, 0), height(0, 1), height(1, 1)},
                                      column - static_cast<double>(c),
                                      row - static_cast<double>(r)));
  };
}

TerrainError grid_error(const BathymetryGrid& grid, const TrueDepth& truth, CompareAt where) {
  std::vector<double> errors;
  std::size_t known = 0, sounded = 0;
  for (std::size_t i = 0; i < grid.cells(); ++i) {
    const double column = static_cast<double>(i % grid.columns),
                 row = static_cast<double>(i / grid.columns);
    const auto depth_at = [&](double across, double down) {
      return truth((static_cast<double>(grid.first_column) + column + across) * grid.cell_m,
                   (static_cast<double>(grid.first_row) + row + down) * grid.cell_m);
    };
    const double at_centre = depth_at(0.5, 0.5);
    if (!std::isnan(at_centre)) {
      ++known;
      if (grid.count[i] > 0) ++sounded;
    }
    if (grid.count[i] == 0) continue;
    const double depth = where == CompareAt::kCellCentre
                             ? at_centre
                             : depth_at(grid.centroid[i][0], grid.centroid[i][1]);
    if (!std::isnan(depth)) errors.push_back(grid.mean_m[i] - depth);
  }
  TerrainError out = summary(errors);
  out.coverage = known > 0 ? static_cast<double>(sounded) / static_cast<double>(known) : 0.0;
  return out;
}

TerrainError point_error(std::span<const Vec3> points_world_m, const TrueDepth& truth) {
  std::vector<double> errors;
  for (const Vec3& p : points_world_m)
    if (const double depth = truth(p.x, p.z); !std::isnan(depth)) errors.push_back(-p.y - depth);
  return summary(errors);
}

nlohmann::json to_json(const TerrainError& error) {
  return {{"count", error.count},     {"rms_m", error.rms_m},     {"mean_m", error.mean_m},
          {"p95_abs_m", error.p95_m}, {"max_abs_m", error.max_m}, {"coverage", error.coverage}};
}

}  // namespace neritic::sonar
