// A vehicle and its controller flown together: the controller at its rate, the vehicle in between
// with its commands held. For checks, tests and tables; a running simulation does the same step by
// step. Any thread.
#pragma once

#include <functional>
#include <vector>

#include "rov/controller.hpp"
#include "rov/step.hpp"

namespace neritic::rov {

// The setpoint, asked once per control period.
using Guide = std::function<Setpoint(const State& state, double t_s)>;

struct LoopRun {
  std::vector<State> states;  // one a control period, the start included
  double period_s = 0.0;
  double largest_thruster_n = 0.0;  // of all commands
  double largest_tilt_rad = 0.0;    // off upright
};

// The vehicle's steps within a control period.
struct LoopSteps {
  int count = 5;
  Integrator integrator = Integrator::kGuarded;
  bool level_first = false;  // by level_inputs() (thrust_priority.hpp)
};
LoopRun fly(const Vehicle& vehicle, const ControlGains& gains, const State& start,
            const Guide& guide, double seconds, const LoopSteps& steps = {});

// How a step from 0 to 1 was answered, by the states' samples of a quantity that is 0 at the start
// and 1 at the setpoint.
struct StepResponse {
  double rise_10_90_s = 0.0, t90_s = 0.0;
  double overshoot = 0.0;    // 0.01 is 1 %
  double settled_s = 0.0;    // from here on within 5 %
  double final_error = 0.0;  // the last value less 1
};
StepResponse step_response(const std::vector<double>& values, double period_s);

}  // namespace neritic::rov
