// Convex hulls by Bullet: corners and triangles of a set of points. Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/math.hpp"

namespace neritic::sim {

struct ConvexHull {
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // outward
  double inner_radius = 0.0;  // nearest face to the mean of the corners; 0: flat
};

// Points are finite. Every face is moved inwards by shrink, which is cut to a fifth of the inner
// radius. A set without volume has no triangles.
struct HullOptions {
  double shrink = 0.0;
};
struct HullResult {
  ConvexHull hull;
  double shrunk = 0.0;
};
HullResult convex_hull(std::span<const Vec3> points, const HullOptions& options = {});

}  // namespace neritic::sim
