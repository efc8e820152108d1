// A run as a log of the samples that it used, and back: what `--record` writes and `--replay`
// reads. Pure functions; any thread while the simulation rests.
#pragma once

#include "testbed/samples/sample_log.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// Precondition: the simulation keeps its log, and began at step 0.
SampleLog recorded_run(const PhysicsWorld& world, const PhysicsSimulation& simulation);

// Runs the log again: its samples enter by a RecordedSource, and each state's hash is compared.
// kBadInput for a log of another step or with samples of other streams. name stands in messages.
Result<sim::ReplayReport> replay_run(const PhysicsWorld& world, SampleLog log,
                                     const std::string& name);

}  // namespace neritic::testbed
