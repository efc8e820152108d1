// The files that flags ask a run of physics to write (--log, --plot, --record, --save), as step
// sinks, and its progress on a terminal.
#pragma once

#include <memory>
#include <optional>

#include "testbed/motion/live_physics.hpp"
#include "testbed/record/file_sinks.hpp"
#include "testbed/record/recording_file.hpp"
#include "tools/common/outputs.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {

// The first flag that was given; empty: none.
std::string first_step_flag(const StepFileFlags& flags);
// For a flag of physics in a scene where nothing moves by physics. scene: its path.
Error flag_without_physics(const std::string& flag, const std::string& scene);
// Checks these files and others that the command writes: kBadInput for a rate that is none and for
// two flags with one file, kIo for a file that cannot be written: better known before a run of
// hours than after it.
Status check_step_files(const StepFileFlags& flags, const std::vector<OutputFile>& others);

// The sinks that the flags name, in the order in which they finish. The log's figures are always
// there, for the summary.
class StepFiles {
 public:
  // title: of the scene, for the plot; recording: of the scene, for --record. The physics outlives
  // it.
  StepFiles(const StepFileFlags& flags, const std::string& title,
            const testbed::RecordingOptions& recording, const testbed::LivePhysics& physics);
  std::vector<testbed::StepSink*> sinks() const;
  // For --record; nullptr: there is none.
  testbed::RecordingFile* recording() const { return recording_; }
  const testbed::DiveRecorder& recorder() const { return log_->recorder(); }

 private:
  std::vector<std::unique_ptr<testbed::StepSink>> files_;
  testbed::DiveLog* log_ = nullptr;  // one of them
  testbed::RecordingFile* recording_ = nullptr;
};

// Counts simulated seconds up to a time.
class StepProgress final : public testbed::StepSink {
 public:
  StepProgress(std::string what, double until_s) : what_(std::move(what)), until_s_(until_s) {}
  Status accept(const sim::Snapshot<testbed::PhysicsState>& step,
                std::span<const testbed::Sample> outputs) override;
  Status finish() override;

 private:
  std::string what_;
  double until_s_, told_s_ = 0.0;
  bool begun_ = false;
  std::optional<Progress> progress_;
};

}  // namespace neritic::tools
