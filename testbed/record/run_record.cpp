#include "testbed/record/run_record.hpp"

namespace neritic::testbed {

SampleLog recorded_run(const PhysicsWorld& world, const PhysicsSimulation& simulation) {
  const PhysicsSimulation::Log& log = simulation.log();
  NERITIC_CHECK(log.first_step == 0, "the log begins at step {}", log.first_step);
  SampleLog out{
      log.step_s, log.seed,  logged_streams(world.streams()), simulation.inbox().source_names(),
      {},         log.hashes};
  out.entries.reserve(log.entries.size());
  for (const auto& entry : log.entries) out.entries.push_back({entry.step, entry.message});
  return out;
}

sim::ReplayReport replay_run(const PhysicsWorld& world, const SampleLog& log) {
  PhysicsSimulation::Log run{log.step_s, log.seed, 0, world.start_inputs(), {}, log.hashes};
  run.entries.reserve(log.entries.size());
  for (const SampleLog::Entry& entry : log.entries)
    run.entries.push_back({entry.step, entry.sample});
  return sim::replay(run, world.start(), world.step_function(),
                     [&](PhysicsInputs& inputs, const Sample& sample, std::uint64_t step) {
                       world.apply(inputs, sample, step);
                     });
}

}  // namespace neritic::testbed
