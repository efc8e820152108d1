// A recording that a person begins and ends while a run goes on: the samples that the run uses and
// the hash of each state (NAME.log), the log of its participants (NAME.csv) and, if the run is past
// its start, the state that the recording begins with (NAME.state): `--restore NAME.state --replay
// NAME.log` runs it again. While it is off a step costs one test.
#pragma once

#include <atomic>
#include <optional>

#include "testbed/record/file_sinks.hpp"

namespace neritic::testbed {

class RecordingSwitch final : public StepSink {
 public:
  explicit RecordingSwitch(const PhysicsWorld& world) : world_(world) {}

  // Between two steps. base: the files' path without an extension; the folder is there. kIo if the
  // state cannot be written. Precondition: it is off.
  Status begin(const PhysicsSimulation& simulation, std::filesystem::path base);
  // Between two steps: takes no more. Gives what writes the rest, and the files their names.
  std::unique_ptr<StepSink> end();
  bool on() const { return files_ != nullptr; }
  const std::filesystem::path& log() const { return log_; }
  double begun_s() const { return begun_s_; }
  // Any thread: a file failed, so that the recording takes no more. The run goes on.
  bool failed() const { return failed_; }

  Status use(const Sample& sample) override;
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override;
  // Of one that is still on when the run ends.
  Status finish() override { return files_ ? end()->finish() : Status(); }

 private:
  class Files;
  const PhysicsWorld& world_;
  std::unique_ptr<StepSink> files_;  // of a recording
  std::filesystem::path log_;
  double begun_s_ = 0.0;
  std::atomic<bool> failed_{false};
};

}  // namespace neritic::testbed
