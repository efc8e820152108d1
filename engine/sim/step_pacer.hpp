// The steps that a clock asks for: a step every 1 / rate. After a delay a few at once, and a short
// delay is caught up whole. Beyond that time is dropped and counted, so that a slow machine slows
// the simulation down and never piles up work. Pure arithmetic on times that the caller reads; one
// thread.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/core/clock.hpp"

namespace neritic::sim {

inline constexpr double kMinRate_hz = 60.0, kMaxRate_hz = 1000.0, kDefaultRate_hz = 240.0;
// A simulation that runs by a clock takes at most so many steps at once, and a step may be so late.
inline constexpr int kMaxCatchUp = 4;
inline constexpr TimeNs kMostLate_ns = 100'000'000;

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

  static constexpr TimeNs kMostCatchUp_ns = 250'000'000;

  // rate_hz > 0, max_catch_up >= 1: most steps at once. The first step is due one period after
  // start_ns. most_late_ns: steps that are late by up to this wait for their turn. If the delay is
  // not caught up within kMostCatchUp_ns, the machine is too slow: until it has caught up, and
  // always where most_late_ns is 0, those beyond max_catch_up are dropped.
  StepPacer(double rate_hz, int max_catch_up, TimeNs start_ns, TimeNs most_late_ns = 0);

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
  std::int64_t most_late_;           // steps that may wait, those that run included
  TimeNs origin_ns_;                 // start, moved on by what was dropped
  std::optional<TimeNs> behind_ns_;  // since then more than one step was due at each look
  std::int64_t done_ = 0;            // steps taken
  Counts counts_;
};

}  // namespace neritic::sim
