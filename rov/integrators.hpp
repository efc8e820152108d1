// The methods behind step.hpp, each over motion through the water (dynamics.hpp). Pure functions
// without allocation; any thread.
#pragma once

#include "rov/step.hpp"

namespace neritic::rov {

// A step that has its inputs checked. motion and lag are advanced in place.
struct StepTask {
  const Vehicle& vehicle;
  const Inputs& inputs;  // good
  VaryingWrench varying;
  double dt_s;

  // The wrench of the inputs t seconds after the start, without thrusters.
  Vec6 wrench_at(double t_s) const {
    return varying.at ? inputs.wrench + varying.at(varying.context, t_s) : inputs.wrench;
  }
};
using LagStates = std::array<LagState, kMaxThrusters>;

// With implicit Coriolis terms no step is too long to be stable, but motions that should swing are
// damped; without them it is the other way round.
void semi_implicit(const StepTask& task, int substeps, bool implicit_coriolis, WaterMotion& motion,
                   LagStates& lag);
void rk4(const StepTask& task, WaterMotion& motion, LagStates& lag);
// The lag exactly, the rest by RK4. The thrusters' impulse is known beforehand, so
// that RK4 sees nu less that impulse's share, whose slope has none of the lag's fast swings.
void split_rk4(const StepTask& task, int substeps, WaterMotion& motion, LagStates& lag);

// The vector's length is 1 again.
void normalise(Quat& q);
// An upper bound, 1/s, of how fast anything but the lag changes from here on.
double change_rate(const Vehicle& vehicle, const WaterMotion& motion, const WaterMotion& rate);

}  // namespace neritic::rov
