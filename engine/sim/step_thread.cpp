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
    const int steps = pacer_.take(clock_.now());
    for (int i = 0; i < steps; ++i) step_(pacer_.taken_ns(steps, i));
    const StepPacer::Counts& counts = pacer_.counts();
    steps_ = counts.steps;
    caught_up_ = counts.caught_up;
    dropped_ = counts.dropped;
    dropped_ns_ = counts.dropped_ns;
    if (steps == 0) clock_.wait_until(pacer_.next_ns());
  }
}

StepPacer::Counts StepThread::counts() const {
  return {steps_, caught_up_, dropped_, dropped_ns_};
}

}  // namespace neritic::sim
