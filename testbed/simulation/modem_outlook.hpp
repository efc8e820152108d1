// USBLs that give no fix as a dive begins, told before it (mission_outlook.hpp): a line each. What
// never gives one is refused (modems.hpp). Pure function; any thread.
#pragma once

#include <string>
#include <vector>

#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// Where everything starts: a modem in the air, a request or an answer below what its receiver
// detects, an answer that comes after its asker has ceased to wait, and two that ask at the same
// instants in a band of both, so that their requests collide.
void add_ranging(const PhysicsWorld& world, const PhysicsState& start,
                 std::vector<std::string>& lines);

}  // namespace neritic::testbed
