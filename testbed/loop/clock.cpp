#include "testbed/loop/clock.hpp"

#include <algorithm>

#include "engine/core/clock.hpp"
#include "engine/sim/step_clock.hpp"

namespace neritic::testbed {

Clock Clock::real(double start_s, double period_s, Frames frames, sim::RunClock* run) {
  return {true, start_s, period_s, frames, run};
}

Clock Clock::simulated(double start_s, double period_s) {
  return {false, start_s, period_s, Frames::kSteps, nullptr};
}

Clock Clock::steps(std::uint64_t first, double period_s) {
  Clock clock = simulated(0.0, period_s);
  clock.frames_ = first;
  return clock;
}

TimeNs Clock::wait_for_due() {
  sim::HostClock host;
  sim::StepClock& clock = run_ ? static_cast<sim::StepClock&>(*run_) : host;
  if (!pacer_ && kind_ == Frames::kSteps)
    pacer_.emplace(1.0 / period_s_, sim::kMaxCatchUp, clock.now(), sim::kMostLate_ns);
  else if (!pacer_)
    pacer_.emplace(1.0 / period_s_, 1, clock.now());
  while (due_ == 0) {
    clock.wait_until(pacer_->next_ns());
    given_ = due_ = pacer_->take(clock.now());
  }
  --due_;
  return pacer_->taken_ns(given_, given_ - 1 - due_);
}

// A display's time that hardly moves for a second stands: frames go on by the host's until it has
// caught up, so that what it is to show ends.
void Clock::see(TimeNs display_at_ns) {
  constexpr TimeNs kStands_ns = 1'000'000'000;
  constexpr std::int64_t kHardly = 50;  // times as slow as the host's
  const TimeNs host_ns = now_ns(), run_ns = run_ ? run_->now() : host_ns;
  const bool first = frames_ == 1;
  // A pause begins now, before the frame that was to be seen already.
  seen_ns_ = std::max(seen_ns_, run_ ? run_->at(display_at_ns) : display_at_ns);
  if (first || kHardly * (display_at_ns - moved_to_ns_) >= host_ns - moved_ns_)
    moved_ns_ = host_ns, moved_to_ns_ = display_at_ns;
  else if (host_ns - moved_ns_ > kStands_ns)
    seen_ns_ += run_ns - saw_ns_;
  saw_ns_ = run_ns;
  if (first) begun_ns_ = seen_ns_;
}

FrameTime Clock::next(std::optional<TimeNs> display_at_ns) {
  const auto frame = static_cast<double>(frames_++);
  if (real_ && display_at_ns) {
    see(*display_at_ns);
    const double time_s = start_s_ + 1e-9 * static_cast<double>(seen_ns_ - begun_ns_);
    return {time_s, time_s, seen_ns_, *display_at_ns};
  }
  const TimeNs run_ns = real_ ? wait_for_due() : display_at_ns.value_or(0);
  const double time_s = start_s_ + (frame + static_cast<double>(dropped())) * period_s_;
  const TimeNs host_ns = !real_ ? 0 : run_ ? run_->host_at(run_ns) : run_ns;
  return {time_s, time_s + period_s_, run_ns, host_ns};
}

}  // namespace neritic::testbed
