// When sensors that run at rates of their own are due, frame by frame. Plain data; one thread.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace neritic::testbed {

class PingSchedule {
 public:
  explicit PingSchedule(const std::vector<double>& rates_hz);

  struct Due {
    std::size_t sensor = 0;    // by place in the rates
    std::uint32_t number = 0;  // of its ping: 0, 1, 2, ...
  };
  // The sensors whose time has come: at the first call all, then each a period after its last, on
  // its own beat. A late sensor pings once, not once for each ping missed. If the
  // time falls, since the run went back, all begin their beat anew.
  std::vector<Due> due(double time_s);
  // This sensor goes on with the beat of another schedule's, if that has the same rate.
  void go_on(std::size_t sensor, const PingSchedule& from, std::size_t its);

 private:
  struct Sensor {
    double period_s = 0.0, next_s = 0.0;
    std::uint32_t pings = 0;
  };
  std::vector<Sensor> sensors_;
  double last_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace neritic::testbed
