// The log of a run's samples as a source of another run, and the comparison of their states: what
// `--replay` does. Pure functions; any thread while the simulation rests.
#pragma once

#include "testbed/record/step_sink.hpp"
#include "testbed/samples/recorded_source.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// The samples of a log as a source for this world. kBadInput for a log of another step or with
// samples of other streams. name stands in messages. start_step: of the run, where the log begins.
Result<RecordedSource> source_of(const PhysicsWorld& world, SampleLog log, const std::string& name,
                                 std::uint64_t start_step = 0);

// Compares each state with the recorded one, as long as the recording lasts.
class RecordingCheck final : public StepSink {
 public:
  // Borrows the hashes, of each state from start_step on.
  RecordingCheck(std::span<const std::uint64_t> hashes, std::string name,
                 std::uint64_t start_step = 0)
      : hashes_(hashes), name_(std::move(name)), start_step_(start_step) {}
  // kUnsupported from the first state on that differs.
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override;
  Status finish() override { return {}; }
  std::uint64_t equal_steps() const { return equal_; }

 private:
  std::span<const std::uint64_t> hashes_;
  std::string name_;
  std::uint64_t start_step_ = 0;
  std::uint64_t equal_ = 0;  // steps that were compared
};

}  // namespace neritic::testbed
