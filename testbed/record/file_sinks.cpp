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

RecordingFile::RecordingFile(const PhysicsWorld& world, const SampleInbox& inbox,
                             std::filesystem::path path)
    : inbox_(inbox),
      log_(world.step_s(), world.seed(), logged_streams(world.streams())),
      file_(std::move(path), log_.take(), [](const std::string& bytes) { return bytes; }) {}

void RecordingFile::name_sources() {
  const auto names = inbox_.source_names();
  while (log_.sources() < names.size()) log_.source(names[log_.sources()]);
}

Status RecordingFile::use(const Sample& sample) {
  if (sample.header.source >= log_.sources()) name_sources();
  log_.sample(sample);
  return {};
}

Status RecordingFile::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) {
  log_.hash(step.hash);
  return file_.add(log_.take());
}

Status RecordingFile::finish() {
  name_sources();
  log_.end();
  if (const Status added = file_.add(log_.take()); !added.ok()) return added;
  return file_.finish();
}

Status StateFile::finish() {
  return write_state(path_, world_.state_format(), saved_state(simulation_, world_.state_format()));
}

}  // namespace neritic::testbed
