// The loop of the stepping thread.
#include "engine/sim/step_thread.hpp"

#include <utility>

#include "engine/core/thread_urgency.hpp"

namespace neritic::sim {

StepThread::StepThread(StepClock& clock, const StepPacer& pacer, std::function<void(TimeNs)> step)
    : clock_(clock), pacer_(pacer), step_(std::move(step)), thread_([this] { run(); }) {}

void StepThread::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void StepThread::run() {
  set_urgency(ThreadUrgency::kSoon);
  while (!stop_) {
    TimeNs next_ns = 0;
    {
      const std::scoped_lock lock(mutex_);
      const int steps = pacer_.take(clock_.now());
      step(steps);
      if (steps > 0) continue;
      next_ns = pacer_.next_ns();
    }
    clock_.wait_until(next_ns);
  }
}

void StepThread::step(int steps) {
  for (int i = 0; i < steps; ++i) {
    const TimeNs begun_ns = now_ns();
    step_(pacer_.taken_ns(steps, i));
    took_ns_ = now_ns() - begun_ns;
  }
  const StepPacer::Counts& counts = pacer_.counts();
  steps_ = counts.steps;
  caught_up_ = counts.caught_up;
  dropped_ = counts.dropped;
  dropped_ns_ = counts.dropped_ns;
}

bool StepThread::hasten(TimeNs most_early_ns, TimeNs most_step_ns) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || took_ns_ > most_step_ns || clock_.stands()) return false;
  const TimeNs begun_ns = clock_.now();  // what is due later is the thread's
  bool taken = false;
  for (int due = pacer_.take(begun_ns); due > 0; due = pacer_.take(begun_ns)) {
    step(due);
    taken = true;
  }
  if (!pacer_.take_early(clock_.now(), most_early_ns)) return taken;
  step(1);
  return true;
}

StepPacer::Counts StepThread::counts() const {
  return {steps_, caught_up_, dropped_, dropped_ns_};
}

}  // namespace neritic::sim
