// The nearest points of two bodies where they stand. Pure function without allocation; any thread.
#pragma once

#include <optional>

#include "engine/sim/body_shape.hpp"

namespace neritic::sim {

struct ShapeGap {
  double gap_m = 0.0;  // negative: the depth of one in the other
  Vec3 point_m{0.0};   // world, midway between the two surfaces
  Vec3 normal{0.0};    // unit, world, from b to a
};

// Nothing if the bodies are farther apart than most_m.
std::optional<ShapeGap> shape_gap(const BodyShape& a, const Pose& world_from_a, const BodyShape& b,
                                  const Pose& world_from_b, double most_m);

}  // namespace neritic::sim
