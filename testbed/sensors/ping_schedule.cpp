#include "testbed/sensors/ping_schedule.hpp"

#include <algorithm>

namespace neritic::testbed {
namespace {

// Share of a period by which frames, whose times are sums of fractions, may come early.
constexpr double kEarly = 1e-6;

}  // namespace

PingSchedule::PingSchedule(const std::vector<double>& rates_hz) {
  for (const double rate_hz : rates_hz) sensors_.push_back({1.0 / rate_hz});
}

std::vector<PingSchedule::Due> PingSchedule::due(double time_s) {
  std::vector<Due> out;
  const bool anew = time_s < last_s_;
  last_s_ = time_s;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    Sensor& s = sensors_[i];
    if (s.pings == 0 || anew) s.next_s = time_s;
    if (time_s < s.next_s - kEarly * s.period_s) continue;
    out.push_back({i, s.pings++});
    s.next_s = std::max(s.next_s + s.period_s, time_s + 0.5 * s.period_s);
  }
  return out;
}

void PingSchedule::go_on(std::size_t sensor, const PingSchedule& from, std::size_t its) {
  last_s_ = from.last_s_;
  if (sensors_[sensor].period_s == from.sensors_[its].period_s)
    sensors_[sensor] = from.sensors_[its];
}

}  // namespace neritic::testbed
