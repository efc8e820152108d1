// Faults of the places of a mission or a diver's plan, told before a dive (mission_outlook.hpp): a
// line each. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// The first waypoint above the surface, and the first that is below the bed or where the vehicle
// would be deeper in something solid than its acceptance: by its own shape, level, at the heading
// that the mission has there.
void add_places(const PhysicsWorld& world, const PhysicsVehicle& vehicle,
                std::vector<std::string>& lines);
// The same of a diver, prone, with the head where the way leads.
void add_places(const PhysicsWorld& world, const PhysicsHuman& human,
                std::vector<std::string>& lines);

// A Doppler log that never hears a bottom: fewer than three of its beams meet something solid
// within their range, level, at any of the places along the way. Of missions whose places are known
// before: waypoints, a station, an orbit; of others where the scene has nothing solid.
void add_doppler_log(const PhysicsWorld& world, const PhysicsVehicle& vehicle,
                     std::vector<std::string>& lines);

// The deepest place that is known before: of the start and of a mission's waypoints. Metres.
double deepest_m(const PhysicsVehicle& vehicle);
// A pressure sensor whose settings are not the scene's water or air, so that the depths that the
// vehicle navigates by are off by over 1 % and 0.1 m there.
void add_pressure(const PhysicsVehicle& vehicle, std::vector<std::string>& lines);

}  // namespace neritic::testbed
