// The places that leave something behind in the water, and that physics moves: where bubbles and
// silt come from. What they left stays where they were.
#pragma once

#include <optional>
#include <vector>

#include "testbed/simulation/object_motion.hpp"

namespace neritic::testbed {

struct FollowedPoint {
  std::size_t object = 0;  // of the scene
  int joint = -1;          // node of its model; -1: the object's origin
  Vec3 position_m{0.0};    // in the object's frame, or the joint's
  double kept_s = 0.0;     // what it left is seen so long
  // The depth of the bed that wash over it raises silt from.
  std::optional<double> bed_depth_m;
  scene::CarriedThing thing;
};

// Empty where nothing of the kind is moved by physics, itself or by what carries it.
std::vector<FollowedPoint> followed_points(const scene::Scene& scene, const Movers& movers);

}  // namespace neritic::testbed
