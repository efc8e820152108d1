// The limits of a scene's missions, told before a dive, and the rest of them after one. Pure
// functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "testbed/simulation/mission_progress.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// A line each, with numbers, for what a vehicle with a mission cannot hold at its start: an axis
// that its thrusters do not push along (failed ones left out), axes that they push only together,
// such as surge with sway and yaw, or surge with a pitch that tilts it; weight or buoyancy beyond
// their vertical thrust, drag in the current of its start and waypoints beyond their thrust at any
// heading, or at the heading of a leg, of an orbit, of its station; a speed over ground that the
// current takes beyond it, a speed through the water that makes no way; a battery whose electronics
// alone empty it before the way is done; a trim moment beyond the thrusters'; a waypoint above the
// surface, below the bed or in something solid; a DVL that never hears a bottom. Thrust is what its
// own saturation gives (rov/allocation.hpp) with all other axes at rest; roll and pitch too, if the
// thrusters control them. For divers who swim by plan: a speed over ground
// faster than legs sustain, or through the water without way; a way that is steeper than divers
// rise and sink. For modems that range: who gives no fix where it starts (modem_outlook.hpp).
std::vector<std::string> cannot_hold(const PhysicsWorld& world);

// A line each for the missions of vehicles and swim plans of divers that are not finished after
// so many seconds from their start, though that was enough: longer than the way takes at its speed
// (vehicles without one: 0.5 m/s) with its stops and 10 s more; or waypoints are missing that twice
// that time was enough for. With the run's progress also for those who make no way to a waypoint,
// with an end or without, and for vehicles off their station, orbit or followed participant at the
// end (mission_progress.hpp). A vehicle that a pilot flies has no mission.
std::vector<std::string> unfinished(const PhysicsWorld& world, const PhysicsState& state,
                                    double seconds, const MissionProgress* progress = nullptr);

}  // namespace neritic::testbed
