// Whole missions of scenes on which the rate that an accepted error picks is measured
// (rov/step_choice.hpp): many vehicles, currents, speeds and things to touch, under control by
// pulses in whole microseconds, as users fly them. One thread.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "rov/step_choice.hpp"

namespace neritic::tools {

struct MissionFlight {
  std::string name;
  std::string scene_text;  // but for its assets and its [physics]
  bool touches = false;    // something solid is there and is touched
};
// 24 in open water, then 8 that touch something; each of its own vehicle, current, speed, way and
// start, drawn by the seed. The default's are those of the sweep.
std::vector<MissionFlight> mission_flights(std::uint64_t seed = 2026);

// How a mission is stepped.
struct MissionStep {
  double hz = 240.0;
  bool rk4 = false;          // plain, in place of the guarded integrator
  double max_error_m = 0.0;  // over 0: the step that this picks, in place of both
};

// Where the vehicle is each 0.1 s, north, east, down. assets: the folder. kBadInput where the scene
// does not load; rates of a multiple of 10 Hz.
Result<std::vector<Vec3>> flown_path(const MissionFlight& flight,
                                     const std::filesystem::path& assets, double seconds,
                                     const MissionStep& step);
double most_apart_m(std::span<const Vec3> a, std::span<const Vec3> b);

struct MissionError {
  std::string flight;
  bool touches = false;
  double truth_error_m = 0.0;  // how sure the truth is
  // In open water at each of measured_rates(), where something is touched for each of
  // kAskedInContact_m.
  std::vector<double> error_m;
  std::vector<double> us_a_second;  // of the clock, all of the scene's step included
};
inline constexpr double kAskedInContact_m[] = {1e-3, 1e-4};
struct MissionSweepOptions {
  std::filesystem::path assets = "assets";
  double seconds = 20.0;
  std::function<void()> step = [] {};
};
// The truth is RK4 at 8 kHz, in contact at 32 kHz; how sure it is, its distance from half that
// rate.
Result<std::vector<MissionError>> fly_missions(std::span<const MissionFlight> flights,
                                               const MissionSweepOptions& options);

}  // namespace neritic::tools
