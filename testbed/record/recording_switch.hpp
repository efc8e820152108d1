// A recording that a person begins and ends while a run goes on: NAME.mcap (recording_file.hpp),
// with the state that it begins with, and the log of its participants (NAME.csv). While it is off a
// step costs one test.
#pragma once

#include <atomic>
#include <optional>

#include "testbed/record/file_sinks.hpp"
#include "testbed/record/recording_file.hpp"

namespace neritic::testbed {

class RecordingSwitch final : public StepSink {
 public:
  explicit RecordingSwitch(const PhysicsWorld& world);
  ~RecordingSwitch() override;

  // Between two steps. base: the files' path without an extension; the folder is there.
  // Precondition: it is off.
  void begin(const PhysicsSimulation& simulation, std::filesystem::path base,
             RecordingOptions options);
  // Between two steps: takes no more. Gives what writes the rest, and the files their names.
  std::unique_ptr<StepSink> end();
  bool on() const { return files_ != nullptr; }
  const std::filesystem::path& file() const { return file_; }
  double begun_s() const { return begun_s_; }
  // Any thread: a file failed, so that the recording takes no more. The run goes on.
  bool failed() const { return failed_; }

  Status use(const Sample& sample) override;
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override;
  // Ends a recording that is still on when the run ends.
  Status finish() override;

 private:
  class Files;
  const PhysicsWorld& world_;
  std::unique_ptr<Files> files_;  // of a recording
  std::filesystem::path file_;
  double begun_s_ = 0.0;
  std::atomic<bool> failed_{false};
};

}  // namespace neritic::testbed
