// The thread that steps at a fixed rate. It belongs to whoever made it and ends with it; the steps
// run one after another, on the thread or on that of a caller who cannot wait for it.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
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
  // Takes all steps that are due, and the next one if it is due within most_early_ns, here and now:
  // a step before its time. False, and no step: time stands, a step runs on the thread just now, or
  // the last one took longer than most_step_ns. Any thread.
  bool hasten(TimeNs most_early_ns, TimeNs most_step_ns);
  // Any thread; each number is the newest, together they may straddle a step.
  StepPacer::Counts counts() const;

 private:
  void run();
  void step(int steps);

  StepClock& clock_;
  std::mutex mutex_;  // held while steps run; guards what follows
  StepPacer pacer_;
  std::function<void(TimeNs)> step_;
  TimeNs took_ns_ = 0;  // the last step
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> steps_{0}, caught_up_{0}, dropped_{0};
  std::atomic<TimeNs> dropped_ns_{0};
  std::thread thread_;  // last: starts when all else is there
};

}  // namespace neritic::sim
