#include "testbed/loop/clock.hpp"

#include "engine/sim/step_clock.hpp"

namespace neritic::testbed {

Clock Clock::real(double start_s, double period_s, int catch_up) {
  return {true, start_s, period_s, catch_up};
}

Clock Clock::simulated(double start_s, double period_s) {
  return {false, start_s, period_s, kCatchUp};
}

TimeNs Clock::wait_for_due() {
  sim::HostClock host;
  if (!pacer_) pacer_.emplace(1.0 / period_s_, catch_up_, host.now());
  while (due_ == 0) {
    host.wait_until(pacer_->next_ns());
    due_ = pacer_->take(host.now());
  }
  --due_;
  return host.now();
}

FrameTime Clock::next(std::optional<TimeNs> display_at_ns) {
  const auto frame = static_cast<double>(frames_++);
  if (real_ && display_at_ns) {
    if (frame == 0.0) begun_ns_ = *display_at_ns;
    const double time_s = start_s_ + 1e-9 * static_cast<double>(*display_at_ns - begun_ns_);
    return {time_s, time_s, *display_at_ns};
  }
  const TimeNs host_ns = real_ ? wait_for_due() : display_at_ns.value_or(0);
  const double time_s = start_s_ + (frame + static_cast<double>(dropped())) * period_s_;
  return {time_s, time_s + period_s_, host_ns};
}

}  // namespace neritic::testbed
