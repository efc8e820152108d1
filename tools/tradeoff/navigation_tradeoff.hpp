// `neritic tradeoff navigation`: how far a vehicle's own navigation errs, and what it costs, over
// the rates of its inertial unit and its DVL, with and without DVL and USBL. The truth is the
// flight that the sensors were made from. One thread.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::tools {

struct NavigationTradeoffOptions {
  std::filesystem::path vehicle = "assets/vehicles/bluerov2_heavy_survey_dynamics.toml";
  bool quick = false;                  // a shorter flight, fewer seeds: to see that it works
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const NavigationTradeoffOptions& options);

struct NavigationPoint {
  std::string aids;          // beside inertial unit, pressure sensor and compass
  std::string sweep;         // "imu" or "dvl": the rate that changes
  double rate_hz = 0.0;      // of that sensor
  double error_m = 0.0;      // of the position, root mean square over flight and seeds
  double end_m = 0.0;        // at the end, over the seeds
  double error_deg = 0.0;    // of the attitude
  double consistency = 0.0;  // mean of the error's square over its covariance: 3 is honest
  double us_a_second = 0.0;  // of one core, a second of flight
  bool is_file = false;      // the rate of the vehicle's file
};

struct NavigationTradeoff {
  std::string vehicle;
  double flight_s = 0.0, way_m = 0.0;
  int seeds = 0;
  std::vector<NavigationPoint> points;
};
Result<NavigationTradeoff> run_navigation_tradeoff(const NavigationTradeoffOptions& options);

// Writes navigation.csv, .md, .json and .plot.json into the folder. True: navigation.png was
// drawn too.
Result<bool> write_navigation_tradeoff(const std::filesystem::path& folder,
                                       const NavigationTradeoff& tradeoff);

}  // namespace neritic::tools
