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

Result<RecordedSource> source_of(const PhysicsWorld& world, SampleLog log,
                                 const std::string& name) {
  if (log.step_s != world.step_s())
    return bad_input("{}: steps of {} s; accepted: {} s, as in the scene", name, log.step_s,
                     world.step_s());
  return RecordedSource::create(std::move(log), world.streams(), name);
}

Status RecordingCheck::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) {
  if (step.step >= hashes_.size()) return {};
  if (step.hash != hashes_[step.step])
    return failure(ErrorCode::kUnsupported, "{}: another state than recorded from step {} of {} on",
                   name_, step.step, hashes_.size() - 1);
  equal_ = step.step;
  return {};
}

}  // namespace neritic::testbed
