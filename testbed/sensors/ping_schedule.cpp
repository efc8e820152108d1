#include "testbed/sensors/ping_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace neritic::testbed {
namespace {

// Share of a period by which frames, whose times are sums of fractions, may come early.
constexpr double kEarly = 1e-6;

}  // namespace

PingSchedule::PingSchedule(const std::vector<double>& rates_hz, Begin begin) : begin_(begin) {
  for (const double rate_hz : rates_hz) sensors_.push_back({1.0 / rate_hz});
}

std::vector<PingSchedule::Due> PingSchedule::due(double time_s) {
  std::vector<Due> out;
  if (time_s < last_s_) restart();
  last_s_ = time_s;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    Sensor& s = sensors_[i];
    if (!std::exchange(s.begun, true))
      s.next_s =
          begin_ == Begin::kAtOnce ? time_s : s.period_s * std::ceil(time_s / s.period_s - kEarly);
    if (time_s < s.next_s - kEarly * s.period_s) continue;
    out.push_back({i, s.pings++});
    s.next_s = begin_ == Begin::kAtOnce
                   ? std::max(s.next_s + s.period_s, time_s + 0.5 * s.period_s)
                   : s.period_s * (std::floor(time_s / s.period_s + kEarly) + 1.0);
  }
  return out;
}

void PingSchedule::go_on(std::size_t sensor, const PingSchedule& from, std::size_t its) {
  last_s_ = from.last_s_;
  if (sensors_[sensor].period_s == from.sensors_[its].period_s)
    sensors_[sensor] = from.sensors_[its];
}

void PingSchedule::restart() {
  for (Sensor& s : sensors_) s.begun = false;
  last_s_ = -std::numeric_limits<double>::infinity();
}

}  // namespace neritic::testbed
