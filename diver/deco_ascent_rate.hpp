// How fast a diver rises, and when to say so: the slope of a line through at least 10 s of depths.
// Two samples of a sensor with 5 cm of noise would make 4 m/min of it, the line 0.3. Pure functions
// over plain bytes; any thread.
#pragma once

#include <array>
#include <cstdint>

namespace neritic::diver {

struct AscentRateLimits {
  double fast_m_min = 9.0, dangerous_m_min = 18.0;
  double window_s = 10.0;   // of the line at least; 2 to 14
  double persists_s = 5.0;  // before it is said
};

// Samples are gathered into means over at least a second; more than the window is not kept.
struct AscentRateState {
  static constexpr std::size_t kMeans = 16;
  std::array<double, kMeans> time_s{}, depth_m{};  // oldest first
  std::uint64_t count = 0;                         // of them that are filled
  // The mean that is being gathered.
  double sum_time_s = 0.0, sum_depth_m = 0.0, began_s = 0.0;
  std::uint64_t samples = 0;
  double now_s = 0.0;
  double rate_m_min = 0.0;                               // upwards is positive
  double fast_since_s = -1.0, dangerous_since_s = -1.0;  // negative: it is not

  static void fields(auto&& field, auto& self) {
    field("time_s", self.time_s);
    field("depth_m", self.depth_m);
    field("count", self.count);
    field("sum_time_s", self.sum_time_s);
    field("sum_depth_m", self.sum_depth_m);
    field("began_s", self.began_s);
    field("samples", self.samples);
    field("now_s", self.now_s);
    field("rate_m_min", self.rate_m_min);
    field("fast_since_s", self.fast_since_s);
    field("dangerous_since_s", self.dangerous_since_s);
  }
};

// After a depth, dt_s after the last one. Finite numbers, dt_s >= 0.
AscentRateState observe(const AscentRateState& before, double depth_m, double dt_s,
                        const AscentRateLimits& limits);

enum class AscentAlarm { kNone, kFast, kDangerous };
const char* name_of(AscentAlarm alarm);  // "none", "fast", "dangerous"
AscentAlarm alarm_of(const AscentRateState& state, const AscentRateLimits& limits);

}  // namespace neritic::diver
