// How far soundings and charts lie from the true bottom. Errors are measured depth minus true
// depth: positive is too deep. Pure functions; any thread.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "engine/core/math.hpp"
#include "engine/scene/shapes.hpp"
#include "sonar/bathymetry.hpp"

namespace neritic::sonar {

// The bottom's depth in metres at x, z of the world; NaN where there is none.
using TrueDepth = std::function<double(double x_m, double z_m)>;

// Depth of a heightfield's mesh (scene::make_terrain: the same triangles, not bilinear patches),
// whose model frame has its origin at position_m and the world's axes.
TrueDepth true_depth(std::shared_ptr<const scene::Heightfield> field, const Vec3& position_m);

struct TerrainError {
  std::size_t count = 0;  // of what was compared; with 0 the numbers are NaN
  double rms_m = 0, mean_m = 0, p95_m = 0, max_m = 0;  // p95, max of the absolute error
  // For a grid, the sounded part of the cells that have a true depth at their centre. 1 for
  // points.
  double coverage = 1.0;
};

// kCellCentre: a cell's mean against the depth at its centre, as a user of the chart reads it: on a
// slope this holds the scatter of soundings within the cell. kCentroid: against the depth at the
// mean position of the cell's soundings, which leaves the sonar's own error.
enum class CompareAt { kCellCentre, kCentroid };
TerrainError grid_error(const BathymetryGrid& grid, const TrueDepth& truth, CompareAt where);
// Soundings one by one, e.g. those at nadir.
TerrainError point_error(std::span<const Vec3> points_world_m, const TrueDepth& truth);

nlohmann::json to_json(const TerrainError& error);

}  // namespace neritic::sonar
