// Receivers of each step of a running simulation: the log, the plot, the recording, the saved
// state, a server. Their owner makes them before the first step and finishes them after the
// last.
#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "testbed/simulation/output_samples.hpp"

namespace neritic::testbed {

class StepSink {
 public:
  virtual ~StepSink() = default;
  // The streams whose samples it takes beside the states, asked once. Others cost nothing.
  virtual std::vector<StreamId> streams() const { return {}; }
  // The stepping thread. Each sample that the next step uses, in their order.
  virtual Status use(const Sample&) { return {}; }
  // The stepping thread. Each step's state in turn, the start (or the restored state) first.
  // outputs: the samples that are due at this step, of the streams of all sinks. An Error ends the
  // run.
  virtual Status accept(const sim::Snapshot<PhysicsState>& step,
                        std::span<const Sample> outputs) = 0;
  // The owner's thread, after the last step: writes.
  virtual Status finish() = 0;
};

// Gives each step to several sinks; after the first failure to none.
class StepSinks {
 public:
  // Borrows the world and the sinks.
  StepSinks(const PhysicsWorld& world, std::vector<StepSink*> sinks);

  // The stepping thread, as the sinks want them.
  void use(const Sample& sample);
  void accept(const sim::Snapshot<PhysicsState>& step);
  // Any thread.
  bool failed() const { return failed_; }
  // The owner's thread, after the last step. Finishes every sink, also where one of them fails.
  // Returns the first failure, of use and accept too.
  Status finish();

 private:
  template <class Give>
  void give(Give&& give);

  std::vector<StepSink*> sinks_;
  OutputSamples outputs_;
  Status status_;  // of use and accept
  std::atomic<bool> failed_{false};
};

}  // namespace neritic::testbed
