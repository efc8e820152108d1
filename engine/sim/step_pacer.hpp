// The steps that a clock asks for: a step every 1 / rate, a few at once after a delay, and beyond
// those time is dropped and counted, so that a slow machine slows the simulation down and never
// piles up work. Pure arithmetic on times that the caller reads; one thread.
#pragma once

#include <cstdint>

#include "engine/core/clock.hpp"

namespace neritic::sim {

inline constexpr double kMinRate_hz = 60.0, kMaxRate_hz = 1000.0, kDefaultRate_hz = 240.0;

class StepPacer {
 public:
  struct Counts {
    std::uint64_t steps = 0, caught_up = 0;  // all; of those, the ones that had to be caught up
    std::uint64_t dropped = 0;               // steps that never ran
    TimeNs dropped_ns = 0;
    Counts operator+(const Counts& other) const {
      return {steps + other.steps, caught_up + other.caught_up, dropped + other.dropped,
              dropped_ns + other.dropped_ns};
    }
  };

  // rate_hz > 0, max_catch_up >= 1: most steps at once. The first step is due one period after
  // start_ns.
  StepPacer(double rate_hz, int max_catch_up, TimeNs start_ns);

  // How many steps to run at now_ns; they count as run. A clock that goes back asks for none.
  int take(TimeNs now_ns);
  // Whether the next step is due within so long; then it counts as run.
  bool take_early(TimeNs now_ns, TimeNs most_early_ns);
  // When the next step is due.
  TimeNs next_ns() const { return due_ns(done_ + 1); }
  // When the i-th of the steps that take() or take_early() just gave was due, i from 0.
  TimeNs taken_ns(int taken, int i) const { return due_ns(done_ - taken + 1 + i); }
  const Counts& counts() const { return counts_; }

 private:
  // From the origin, so that rounding to nanoseconds does not add up.
  TimeNs due_ns(std::int64_t step) const;

  double period_ns_;
  int max_catch_up_;
  TimeNs origin_ns_;       // start, moved on by what was dropped
  std::int64_t done_ = 0;  // steps taken
  Counts counts_;
};

}  // namespace neritic::sim
