// The thread that steps at a fixed rate. It belongs to whoever made it and ends with it; the step
// itself runs on the thread, one call after another.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "engine/sim/step_clock.hpp"
#include "engine/sim/step_pacer.hpp"

namespace neritic::sim {

class StepThread {
 public:
  // step(due_ns) runs one step that was due then. The clock outlives the thread.
  StepThread(StepClock& clock, const StepPacer& pacer, std::function<void(TimeNs due_ns)> step);
  ~StepThread() { stop(); }
  StepThread(const StepThread&) = delete;
  StepThread& operator=(const StepThread&) = delete;

  // Ends after the steps at hand; counts() are final then. The owner's thread.
  void stop();
  // Any thread; each number is the newest, together they may straddle a step.
  StepPacer::Counts counts() const;

 private:
  void run();

  StepClock& clock_;
  StepPacer pacer_;  // the thread's
  std::function<void(TimeNs)> step_;
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> steps_{0}, caught_up_{0}, dropped_{0};
  std::atomic<TimeNs> dropped_ns_{0};
  std::thread thread_;  // last: starts when all else is there
};

}  // namespace neritic::sim
