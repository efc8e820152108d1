#include "engine/sim/run_clock.hpp"

#include <algorithm>

namespace neritic::sim {
namespace {

constexpr TimeNs kLongestWait_ns = 5'000'000;

}  // namespace

RunClock::RunClock(StepClock& host)
    : host_(host), host_base_ns_(host.now()), run_base_ns_(host_base_ns_) {}

TimeNs RunClock::at_locked(TimeNs host_ns) const {
  const auto passed_ns = static_cast<double>(std::max<TimeNs>(host_ns - host_base_ns_, 0));
  const TimeNs run_ns = run_base_ns_ + static_cast<TimeNs>(passed_ns * speed_);
  return paused_ ? std::min(run_ns, limit_ns_) : run_ns;
}

// Time that has passed stays, whatever changes now.
void RunClock::rebase() {
  const TimeNs host_ns = host_.now();
  run_base_ns_ = at_locked(host_ns);
  host_base_ns_ = host_ns;
}

TimeNs RunClock::now() {
  const std::scoped_lock lock(mutex_);
  return at_locked(host_.now());
}

TimeNs RunClock::at(TimeNs host_ns) {
  const std::scoped_lock lock(mutex_);
  return at_locked(host_ns);
}

void RunClock::wait_until(TimeNs run_ns) {
  double host_wait_ns = static_cast<double>(kLongestWait_ns);
  {
    const std::scoped_lock lock(mutex_);
    const TimeNs left_ns = run_ns - at_locked(host_.now());
    if (left_ns <= 0) return;
    if (!paused_) host_wait_ns = std::min(host_wait_ns, static_cast<double>(left_ns) / speed_);
  }
  host_.wait_until(host_.now() + static_cast<TimeNs>(host_wait_ns) + 1);
}

TimeNs RunClock::host_at(TimeNs run_ns) {
  const std::scoped_lock lock(mutex_);
  const TimeNs host_ns = host_.now();
  const TimeNs ago_ns = at_locked(host_ns) - run_ns;
  return host_ns - static_cast<TimeNs>(static_cast<double>(ago_ns) / speed_);
}

void RunClock::set_speed(double speed) {
  const std::scoped_lock lock(mutex_);
  rebase();
  speed_ = std::clamp(speed, kSlowest, kFastest);
}

double RunClock::speed() {
  const std::scoped_lock lock(mutex_);
  return speed_;
}

void RunClock::pause(bool paused) {
  const std::scoped_lock lock(mutex_);
  rebase();
  paused_ = paused;
  limit_ns_ = run_base_ns_;
}

bool RunClock::paused() {
  const std::scoped_lock lock(mutex_);
  return paused_;
}

void RunClock::step(TimeNs duration_ns) {
  const std::scoped_lock lock(mutex_);
  if (!paused_) return;
  rebase();
  limit_ns_ = std::max(limit_ns_, run_base_ns_) + duration_ns;
}

}  // namespace neritic::sim
