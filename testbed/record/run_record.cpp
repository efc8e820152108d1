#include "testbed/record/run_record.hpp"

namespace neritic::testbed {

Result<RecordedSource> source_of(const PhysicsWorld& world, SampleLog log, const std::string& name,
                                 std::uint64_t start_step) {
  if (log.step_s != world.step_s())
    return bad_input("{}: steps of {} s; accepted: {} s, as in the scene", name, log.step_s,
                     world.step_s());
  return RecordedSource::create(std::move(log), world.streams(), name, start_step);
}

Status RecordingCheck::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) {
  if (step.step < start_step_ || step.step - start_step_ >= hashes_.size()) return {};
  const std::uint64_t at = step.step - start_step_;
  if (step.hash != hashes_[at] && at == 0)
    return bad_input(
        "{}: begins at another state; accepted: the scene that was recorded, and --restore with "
        "the "
        "state that lies beside a recording begun in mid-run",
        name_);
  if (step.hash != hashes_[at])
    return failure(ErrorCode::kUnsupported, "{}: another state than recorded from step {} of {} on",
                   name_, at, hashes_.size() - 1);
  equal_ = at;
  return {};
}

}  // namespace neritic::testbed
