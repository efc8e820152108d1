#include "testbed/record/file_sinks.hpp"

namespace neritic::testbed {

Status DiveLog::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) {
  if (step.step < last_step_) recorder_.emplace(world_, options_);
  last_step_ = step.step;
  recorder_->add(step);
  if (recorder_->rows().empty()) return {};
  for (const auto& sink : rows_) NERITIC_TRY_STATUS(sink->accept(recorder_->rows()));
  recorder_->clear_rows();
  return {};
}

Status DiveLog::finish() {
  Status first;
  for (const auto& sink : rows_)
    if (const Status finished = sink->finish(); first.ok()) first = finished;
  return first;
}

Status StateFile::finish() {
  return write_state(path_, world_.state_format(), saved_state(simulation_, world_.state_format()));
}

}  // namespace neritic::testbed
