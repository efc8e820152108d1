// `neritic tradeoff physics`: how far each integrator of the vehicle's motion strays from the true
// path, and what it costs, over step sizes from 1 to 50 ms, with and without the thrusters' lag, in
// open water and among things that it touches; what bounces, slides and rolls against closed forms;
// and whole missions of scenes at the rates that max_error_m picks (mission_flights.hpp). One
// thread.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "testbed/simulation/body_step.hpp"
#include "tools/tradeoff/mission_flights.hpp"

namespace neritic::tools {

struct PhysicsTradeoffOptions {
  bool quick = false;  // a shorter flight, timed once: to see that it works
  // With the wreck and a vehicle; the assets' folder is the one above its own.
  std::filesystem::path scene = "assets/scenes/mission.toml";
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const PhysicsTradeoffOptions& options);

// The flights (physics_flights.hpp), in this order.
inline constexpr const char* kFlightNames[] = {"no lag",
                                               "lag",
                                               "mission",
                                               "mission, pulses",
                                               "contact, no lag",
                                               "contact, lag",
                                               "mission, contact",
                                               "landing, current",
                                               "uneven sand, current",
                                               "wreck, current",
                                               "bounce",
                                               "slide",
                                               "roll"};

struct PhysicsPoint {
  std::string flight;
  rov::Integrator integrator = rov::Integrator::kGuarded;
  double step_s = 0.0;
  double within_m = 0.0;  // at which halving a step that touches ends; 0: it is not halved
  // The largest over the flight, at every change of the commands. Not finite: it diverged.
  double error_m = 0.0, error_rad = 0.0;
  double us_a_second = 0.0;  // of one core, a second of flight
  double order = 0.0;        // of the error in the step, from the next smaller one; 0: the smallest
};

struct PhysicsTradeoff {
  double flight_s = 0.0;
  std::map<std::string, double> truth_error_m;  // how sure each flight's truth is
  std::vector<PhysicsPoint> points;
  // By the recommended integrator, of all that touches, at the two rates that max_error_m chooses:
  // steps that touch halved more and more.
  std::vector<PhysicsPoint> halved;
  std::vector<MissionError> missions;
};
// The farthest from the truth, by one way to step. Not finite: it diverged.
struct Flight;
struct FlownError {
  double m = 0.0, rad = 0.0;
};
FlownError flown_error(const Flight& flight, double step_s, const testbed::StepMethod& method);
Result<PhysicsTradeoff> run_physics_tradeoff(const PhysicsTradeoffOptions& options);

// The knee of the front of all integrators (no other is both cheaper and better), both axes
// logarithmic.
const PhysicsPoint* knee(const PhysicsTradeoff& tradeoff, const std::string& flight);
// The cheapest whose error is at most max_error_m in open water with and without lag; the one with
// lag is given.
const PhysicsPoint* cheapest(const PhysicsTradeoff& tradeoff, double max_error_m);

// Writes physics.csv, .md, .json and .plot.json into the folder. True: physics.png was
// drawn too.
Result<bool> write_physics_tradeoff(const std::filesystem::path& folder,
                                    const PhysicsTradeoff& tradeoff);

}  // namespace neritic::tools
