// The files that a run of physics leaves: its log, its recording and its last state. Each is a step
// sink; what they borrow outlives them.
#pragma once

#include <filesystem>

#include "testbed/record/dive_record.hpp"
#include "testbed/record/step_sink.hpp"

namespace neritic::testbed {

// Rows and figures of the dive; the rows as a .csv.
class DiveLog final : public StepSink {
 public:
  // csv: empty: no file.
  DiveLog(const PhysicsWorld& world, const RecordOptions& options, std::filesystem::path csv)
      : world_(world), recorder_(world, options), csv_(std::move(csv)) {}
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override;
  Status finish() override;
  const DiveRecorder& recorder() const { return recorder_; }

 private:
  const PhysicsWorld& world_;
  DiveRecorder recorder_;
  std::filesystem::path csv_;
};

// A file that is made of the simulation after the last step.
class EndFile : public StepSink {
 public:
  EndFile(const PhysicsWorld& world, const PhysicsSimulation& simulation,
          std::filesystem::path path)
      : world_(world), simulation_(simulation), path_(std::move(path)) {}
  Status accept(const sim::Snapshot<PhysicsState>&, std::span<const Sample>) final { return {}; }

 protected:
  const PhysicsWorld& world_;
  const PhysicsSimulation& simulation_;
  std::filesystem::path path_;
};

// The samples that the run used, and the hash of each state. The simulation keeps them itself.
// Precondition: the simulation keeps its log, and begins at step 0.
class RecordingFile final : public EndFile {
 public:
  using EndFile::EndFile;
  Status finish() override;
};

// The state after the last step, and the inputs that hold then.
class StateFile final : public EndFile {
 public:
  using EndFile::EndFile;
  Status finish() override;
};

}  // namespace neritic::testbed
