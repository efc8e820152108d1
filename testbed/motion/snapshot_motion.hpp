// The part of a simulation's state that the motion history keeps: poses and velocities of vehicles
// and divers in the world, and the divers' joints. Pure functions; any thread.
#pragma once

#include "testbed/motion/motion_history.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// Vehicles, then divers.
std::vector<MotionHistory::Moved> moved_objects(const PhysicsWorld& world);
MotionSnapshot motion_of(const PhysicsWorld& world, const sim::Snapshot<PhysicsState>& snapshot);

}  // namespace neritic::testbed
