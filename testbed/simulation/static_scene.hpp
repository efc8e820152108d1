// The obstacles of a scene for vehicles: objects with a collision, as they stand. World frame.
// Pure function; any thread.
#pragma once

#include "engine/scene/scene.hpp"
#include "engine/sim/static_world.hpp"

namespace neritic::testbed {

// Whether neither a track, nor physics, nor a device moves it or what carries it.
bool stands_still(const scene::Scene& scene, const scene::Object& object);

// Every vertex of a model at rest, times the scale.
std::vector<Vec3> rest_points(const scene::Model& model, const Vec3& scale);

// Each copy's label is its instance's. Moving things are left out. Errors name the
// object.
Result<sim::StaticWorld> static_world_of(const scene::Scene& scene);

}  // namespace neritic::testbed
