// A run as a log of the samples that it used, and back: what `--record` writes and `--replay`
// reads. Pure functions; any thread while the simulation rests.
#pragma once

#include "testbed/samples/sample_log.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// Precondition: the simulation keeps its log, and began at step 0.
SampleLog recorded_run(const PhysicsWorld& world, const PhysicsSimulation& simulation);

// Precondition: check_streams(log, world.streams()), and the world's step.
sim::ReplayReport replay_run(const PhysicsWorld& world, const SampleLog& log);

}  // namespace neritic::testbed
