#include "testbed/loop/clock.hpp"

#include <algorithm>

#include "engine/sim/step_clock.hpp"

namespace neritic::testbed {

Clock Clock::real(double start_s, double period_s, int catch_up, sim::RunClock* run) {
  return {true, start_s, period_s, catch_up, run};
}

Clock Clock::simulated(double start_s, double period_s) {
  return {false, start_s, period_s, kCatchUp, nullptr};
}

Clock Clock::steps(std::uint64_t first, double period_s) {
  Clock clock = simulated(0.0, period_s);
  clock.frames_ = first;
  return clock;
}

TimeNs Clock::wait_for_due() {
  sim::HostClock host;
  sim::StepClock& clock = run_ ? static_cast<sim::StepClock&>(*run_) : host;
  if (!pacer_) pacer_.emplace(1.0 / period_s_, catch_up_, clock.now());
  while (due_ == 0) {
    clock.wait_until(pacer_->next_ns());
    given_ = due_ = pacer_->take(clock.now());
  }
  --due_;
  return pacer_->taken_ns(given_, given_ - 1 - due_);
}

FrameTime Clock::next(std::optional<TimeNs> display_at_ns) {
  const auto frame = static_cast<double>(frames_++);
  if (real_ && display_at_ns) {
    // A pause begins now, before the frame that was to be seen already.
    seen_ns_ = std::max(seen_ns_, run_ ? run_->at(*display_at_ns) : *display_at_ns);
    if (frame == 0.0) begun_ns_ = seen_ns_;
    const double time_s = start_s_ + 1e-9 * static_cast<double>(seen_ns_ - begun_ns_);
    return {time_s, time_s, seen_ns_, *display_at_ns};
  }
  const TimeNs run_ns = real_ ? wait_for_due() : display_at_ns.value_or(0);
  const double time_s = start_s_ + (frame + static_cast<double>(dropped())) * period_s_;
  const TimeNs host_ns = !real_ ? 0 : run_ ? run_->host_at(run_ns) : run_ns;
  return {time_s, time_s + period_s_, run_ns, host_ns};
}

}  // namespace neritic::testbed
