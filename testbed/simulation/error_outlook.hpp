// What a scene's max_error_m does not promise, told before a dive. Pure function; any thread.
#pragma once

#include <string>

#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// One line, empty where nothing is to be told: the step that max_error_m picks holds the error of
// integration (rov/step_choice.hpp). What is decided on the way is not that: a thruster's pulse in
// whole microseconds, the control period in which a waypoint is reached, a vehicle's own
// navigation, contacts under control; and steps in which participants meet, hold things or pull a
// tether are not refined.
std::string not_promised(const scene::Scene& scene, const PhysicsWorld& world);

}  // namespace neritic::testbed
