#include "testbed/record/file_sinks.hpp"

#include "engine/core/files.hpp"
#include "testbed/record/run_record.hpp"

namespace neritic::testbed {

Status DiveLog::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) {
  recorder_.add(step);
  return {};
}

Status DiveLog::finish() {
  if (csv_.empty()) return {};
  return write_text(csv_, csv_of(world_, recorder_.rows(), recorder_.humans().rows()));
}

Status RecordingFile::finish() {
  return write_sample_log(path_, recorded_run(world_, simulation_));
}

Status StateFile::finish() {
  return write_state(path_, world_.state_format(), saved_state(simulation_, world_.state_format()));
}

}  // namespace neritic::testbed
