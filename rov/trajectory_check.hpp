// Runs cases of trajectories (trajectory_cases.hpp) with a fixed step and compares every sample.
// The integration starts anew at every change of the inputs; a sample between two steps is reached
// by a shorter step beside them. Any thread.
#pragma once

#include "engine/core/check_result.hpp"
#include "rov/step.hpp"
#include "rov/trajectory_cases.hpp"

namespace neritic::rov {

// Errors that the recommended integrator stays below at 240 Hz.
inline constexpr double kPositionBar = 1e-6;  // m
inline constexpr double kAttitudeBar = 1e-6;  // of a quaternion's components, up to its sign
inline constexpr double kVelocityBar = 1e-5;  // m/s, rad/s
inline constexpr double kForceBar = 1e-5;     // N

// The largest errors that a file may claim: of its samples, of a step of fourth order above 120 Hz,
// and of one of first order at any rate; in m, m/s, rad/s and of a quaternion. A larger claim
// counts as this, and the result's note says so.
inline constexpr double kMostReferenceError = 1e-5;
inline constexpr double kMostPromised = 1e-3, kMostPromisedEuler = 10.0;

struct TrajectoryCheck {
  Integrator integrator = Integrator::kGuarded;
  double hz = 240.0;
};

// Errors: Euclidean in position and velocity. Below 120 Hz the bars grow with the step as RK4's
// error does, and plain RK4's of a lagging thruster are wider. Where the file promises a larger
// error for a step as long, twice that is the tolerance, since the end that it speaks of is not
// always the worst place; nor is it finer than the samples' own error. Semi-implicit Euler is
// compared at the end alone, since the file has only that, with bars of order 1.
CaseResult check_trajectory(const TrajectoryCase& one, const TrajectoryCheck& options = {});

// The state at every sample.
std::vector<State> run_trajectory(const TrajectoryCase& one, const TrajectoryCheck& options = {});

}  // namespace neritic::rov
