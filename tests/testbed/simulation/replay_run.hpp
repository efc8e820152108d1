// The log that a simulation keeps in memory, and a recorded run again, without a loop: its samples
// enter before the steps that used them, and each state's hash is compared.
#pragma once

#include "testbed/record/run_record.hpp"

namespace neritic::testbed {

// The log of a run. Precondition: the simulation keeps its log, and began at step 0.
inline SampleLog recorded_run(const PhysicsWorld& world, const PhysicsSimulation& simulation) {
  const PhysicsSimulation::Log& log = simulation.log();
  NERITIC_CHECK(log.first_step == 0, "the log begins at step {}", log.first_step);
  SampleLog out{
      log.step_s, log.seed,  logged_streams(world.streams()), simulation.inbox().source_names(),
      {},         log.hashes};
  out.entries.reserve(log.entries.size());
  for (const auto& entry : log.entries) out.entries.push_back({entry.step, entry.message});
  return out;
}

struct Replayed {
  std::uint64_t steps = 0;  // taken
  std::optional<std::uint64_t> first_difference;
};

inline Result<Replayed> replay_run(const PhysicsWorld& world, SampleLog log,
                                   const std::string& name) {
  NERITIC_TRY(RecordedSource source, source_of(world, std::move(log), name));
  const auto simulation = world.simulation({.log = false});
  const auto& hashes = source.log().hashes;
  Replayed replayed;
  for (std::uint64_t step = 0; step < hashes.size(); ++step) {
    if (simulation->newest().hash != hashes[step]) {
      replayed.first_difference = step;
      return replayed;
    }
    if (step + 1 == hashes.size()) break;
    NERITIC_TRY_STATUS(source.poll(simulation->inbox(), simulation->newest().time_s));
    simulation->advance(1);
    ++replayed.steps;
  }
  return replayed;
}

}  // namespace neritic::testbed
