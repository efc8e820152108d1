// A run as a log of the samples that it used, and back: what `--record` writes and `--replay`
// reads. Pure functions; any thread while the simulation rests.
#pragma once

#include "testbed/record/step_sink.hpp"
#include "testbed/samples/recorded_source.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// Precondition: the simulation keeps its log, and began at step 0.
SampleLog recorded_run(const PhysicsWorld& world, const PhysicsSimulation& simulation);

// The samples of a log as a source for this world. kBadInput for a log of another step or with
// samples of other streams. name stands in messages.
Result<RecordedSource> source_of(const PhysicsWorld& world, SampleLog log, const std::string& name);

// Compares each state with the recorded one, as long as the recording lasts.
class RecordingCheck final : public StepSink {
 public:
  // Borrows the hashes, of each state from step 0 on.
  RecordingCheck(std::span<const std::uint64_t> hashes, std::string name)
      : hashes_(hashes), name_(std::move(name)) {}
  // kUnsupported from the first state on that differs.
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override;
  Status finish() override { return {}; }
  std::uint64_t equal_steps() const { return equal_; }

 private:
  std::span<const std::uint64_t> hashes_;
  std::string name_;
  std::uint64_t equal_ = 0;  // the newest step that was compared
};

}  // namespace neritic::testbed
