// Distance and penetration of two convex sets of points by Bullet's GJK and EPA. The frame is the
// caller's, with its origin near both sets. Pure functions without allocation; any thread.
#pragma once

#include <optional>
#include <span>

#include "engine/core/math.hpp"

namespace neritic::sim {

struct ConvexDistance {
  double distance_m = 0.0;  // between the hulls; negative: how far a must move to leave b
  Vec3 direction{0.0};      // unit, from b to a
  Vec3 point_a{0.0}, point_b{0.0};
};

// At most kMaxCorePoints each. Nothing where Bullet finds no answer.
std::optional<ConvexDistance> convex_distance(std::span<const Vec3> a, std::span<const Vec3> b);

}  // namespace neritic::sim
