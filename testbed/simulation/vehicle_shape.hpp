// A vehicle's shape for contacts: the outline of its file, or the hull of what is drawn of it, or
// the box about that. Model axes. Pure function; any thread.
#pragma once

#include "engine/scene/scene.hpp"
#include "engine/sim/body_shape.hpp"
#include "rov/outline.hpp"

namespace neritic::testbed {

struct VehicleShape {
  sim::BodyShape body;
  double top_m = 0.0, bottom_m = 0.0;  // of what is drawn, above the origin
};

// Errors in one line, without the scene's name.
Result<VehicleShape> vehicle_shape(const scene::Scene& scene, const scene::Object& object,
                                   const std::vector<rov::OutlinePart>& outline);

}  // namespace neritic::testbed
