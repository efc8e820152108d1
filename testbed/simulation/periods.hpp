// Instants of a rate among the steps of a simulation, as logs, samples and computers count them.
// Pure functions; any thread.
#pragma once

#include <cmath>
#include <cstdint>

namespace neritic::testbed {

// How many whole periods have passed at the end of so many steps. The slack is of rounded times: an
// instant at the end of a step belongs to it. Preconditions: step_s >= 0, period_s > 0.
inline std::uint64_t periods_at(std::uint64_t steps, double step_s, double period_s) {
  constexpr double kSlack = 1e-9;  // of a period
  return static_cast<std::uint64_t>(
      std::floor(static_cast<double>(steps) * step_s / period_s + kSlack));
}

// Whether the state after so many steps is the first at or after an instant; the start is.
inline bool period_begins(std::uint64_t steps, double step_s, double period_s) {
  return steps == 0 ||
         periods_at(steps, step_s, period_s) != periods_at(steps - 1, step_s, period_s);
}

}  // namespace neritic::testbed
