// Times between samples, of clocks that may lie anywhere: a recorded source's, or one that counts
// from 1970. Pure functions; any thread.
#pragma once

#include <algorithm>

#include "testbed/samples/sample.hpp"

namespace neritic::testbed {

// To the nanosecond, however far the clock's zero is: as doubles, times of today are 256 ns apart.
inline double seconds_between(TimeNs from_ns, TimeNs to_ns) {
  TimeNs between_ns = 0;
  if (__builtin_sub_overflow(to_ns, from_ns, &between_ns))  // more than 292 years
    return 1e-9 * (static_cast<double>(to_ns) - static_cast<double>(from_ns));
  return 1e-9 * static_cast<double>(between_ns);
}

// From the capture to the arrival, within a second.
inline double age_on_arrival_s(const SampleHeader& header) {
  constexpr double kMost_s = 1.0;
  return std::clamp(seconds_between(header.captured_ns, header.arrived_ns), 0.0, kMost_s);
}

}  // namespace neritic::testbed
