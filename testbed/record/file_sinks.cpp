#include "testbed/record/file_sinks.hpp"

#include <algorithm>

namespace neritic::testbed {

Status DiveLog::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) {
  // The run went to a saved state, which may lie before or after the last step.
  if (begun_ && (step.step < last_step_ || step.step > last_step_ + 1))
    recorder_.emplace(world_, options_, recorder_->stepped_s());
  begun_ = true;
  last_step_ = step.step;
  recorder_->add(step);
  if (recorder_->rows().empty()) return {};
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (failed_[i]) continue;
    const Status taken = rows_[i]->accept(recorder_->rows());
    failed_[i] = !taken.ok();
    if (failed_[i] && on_failure_) on_failure_(taken.error().message);
  }
  recorder_->clear_rows();
  return {};
}

bool DiveLog::failed() const {
  return std::ranges::find(failed_, true) != failed_.end();
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
