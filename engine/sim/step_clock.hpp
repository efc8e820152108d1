// The clock that drives a stepping thread: the host's, or a simulated one that never sleeps.
#pragma once

#include <atomic>

#include "engine/core/clock.hpp"

namespace neritic::sim {

class StepClock {
 public:
  virtual ~StepClock() = default;
  virtual TimeNs now() = 0;
  // Returns when now() is time_ns or later, or earlier where the wait was disturbed.
  virtual void wait_until(TimeNs time_ns) = 0;
  // Whether time does not pass until someone says so.
  virtual bool stands() { return false; }
  // The host's time at a time of this clock near now.
  virtual TimeNs host_at(TimeNs time_ns) { return time_ns; }
};

// engine/core's monotonic clock; sleeps.
class HostClock final : public StepClock {
 public:
  TimeNs now() override { return now_ns(); }
  void wait_until(TimeNs time_ns) override;
};

// Time passes by waiting and by advance() only. Any thread may call any of it.
class SimulatedClock final : public StepClock {
 public:
  explicit SimulatedClock(TimeNs start_ns = 0) : now_(start_ns) {}
  TimeNs now() override { return now_.load(); }
  void wait_until(TimeNs time_ns) override;
  // As if the program had stalled for so long.
  void advance(TimeNs duration_ns) { now_ += duration_ns; }

 private:
  std::atomic<TimeNs> now_;
};

}  // namespace neritic::sim
