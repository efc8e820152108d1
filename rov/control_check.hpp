// Runs cases of control (control_cases.hpp) and compares. Any thread.
#pragma once

#include "engine/core/check_result.hpp"
#include "rov/control_cases.hpp"
#include "rov/step.hpp"

namespace neritic::rov {

// Steps and allocations are compared to kExactBar, relative to the largest number of what is
// compared (absolute where that is below 1). Figures of closed loops: 5 %, and no finer than a
// control period or the last digit that they are given with. The state at the end: kEndBar, ten
// times that in velocity, wider below 120 Hz as RK4 errs; semi-implicit Euler's: kEulerEndBar,
// wider below 240 Hz.
inline constexpr double kExactBar = 1e-9;
inline constexpr double kFigureBar = 0.005;
inline constexpr double kEulerFigureBar = 0.05;
inline constexpr double kEndBar = 1e-6;       // m, of a quaternion's components
inline constexpr double kEulerEndBar = 1e-3;  // the same, and m/s, rad/s

struct ControlCheck {
  Integrator integrator = Integrator::kGuarded;
  double hz = 240.0;  // of the vehicle's steps in closed loops; rounded up to whole steps a period
};
std::vector<CaseResult> check_control(const ControlCases& cases, const ControlCheck& options = {});

}  // namespace neritic::rov
