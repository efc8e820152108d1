// What divers who swim by plan cannot do, told before a dive (mission_outlook.hpp): a line each.
// Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// The speed over ground of a diver who swims at that speed through the water, aslant into the
// current; 0: makes no way.
double made_good_m_s(double through_water_m_s, const Vec3& way_ned, const Vec3& current_ned_m_s);

// The speed through still water that a rested diver reaches with fins or bare feet and all gear:
// swum for half a minute, which takes some 50 ms.
double fastest_m_s(const PhysicsHuman& human);

// The first waypoint to which a plan's speed is beyond fastest_m_s(), and the first in a current
// against which the diver makes no way; the way that is the steepest beyond the rates of ascent and
// descent.
void add_swim(const PhysicsWorld& world, const PhysicsHuman& human,
              std::vector<std::string>& lines);

}  // namespace neritic::testbed
