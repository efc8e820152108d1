// When sensors that run at rates of their own are due, frame by frame. Plain data; one thread.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace neritic::testbed {

class PingSchedule {
 public:
  enum class Begin {
    kAtOnce,  // all are due at the first call, then each a period after its last
    kOnBeat,  // each is due at the multiples of its period, from the first that is not yet past
  };
  explicit PingSchedule(const std::vector<double>& rates_hz, Begin begin = Begin::kAtOnce);

  struct Due {
    std::size_t sensor = 0;    // by place in the rates
    std::uint32_t number = 0;  // of its ping: 0, 1, 2, ...
  };
  // The sensors whose time has come, on the beat of each. A frame between two beats counts for the
  // earlier one if no frame did yet. A late sensor pings once, not once for each ping missed. If
  // the time falls, since the run went back, all begin anew.
  std::vector<Due> due(double time_s);
  // This sensor goes on with the beat of another schedule's, if that has the same rate.
  void go_on(std::size_t sensor, const PingSchedule& from, std::size_t its);
  // The run goes on from another time: all begin anew at the next call.
  void restart();

 private:
  struct Sensor {
    double period_s = 0.0, next_s = 0.0;
    std::uint32_t pings = 0;
    bool begun = false;
  };
  std::vector<Sensor> sensors_;
  Begin begin_;
  double last_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace neritic::testbed
