// The one monotonic host clock: int64 nanoseconds. Any thread.
#pragma once

#include <chrono>
#include <cstdint>

namespace neritic {

using TimeNs = std::int64_t;

inline TimeNs now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}
inline double to_ms(TimeNs duration_ns) {
  return static_cast<double>(duration_ns) * 1e-6;
}

}  // namespace neritic
