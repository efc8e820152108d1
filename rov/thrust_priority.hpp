// Control when the thrusters cannot give all. Moments that hold the vehicle level come first, then
// what holds it at its depth and on its path; what pushes it along the path gets the rest. Cutting
// all by one factor would take moments and depth too: a vehicle at full thrust would overturn, or
// rise and sink about its path. NED; body axes forward, starboard, down. Pure functions without
// allocation of memory; any thread.
#pragma once

#include "rov/controller.hpp"

namespace neritic::rov {

// A wrench in the order in which its parts are given; their sum is all of it.
struct WrenchParts {
  Vec6 level;  // moments, with the Munk moment on top (below)
  Vec6 hold;   // forces across the path, or all forces where the setpoint stands still
  Vec6 push;   // forces along the path, and the pilot's wrench
};

// control_wrench(), clipped in its direction, in parts; and the Munk moment v x M_A v that the
// water turns a moving vehicle broadside with (Fossen 2011, eq. 6.43) and that exceeds the gains.
WrenchParts parted_wrench(const Vehicle& vehicle, const ControlGains& gains,
                          const Setpoint& setpoint, const State& state, ControlState& control);

// control_inputs() with these priorities, each part by gains.saturation beside those before it. A
// speed over ground (Setpoint::over_ground) is held by a push that is learnt (control.speed_n);
// force that the thrusters did not give is not learnt.
Inputs level_inputs(const Vehicle& vehicle, const Allocator& allocator, const ControlGains& gains,
                    const Setpoint& setpoint, const State& state, ControlState& control);
// After it: the part of its wrench that the thrusters do not give, for want of voltage.
void unlearn_push(const Vehicle& vehicle, const ControlGains& gains, const Setpoint& setpoint,
                  const State& state, const Vec6& missing, ControlState& control);

}  // namespace neritic::rov
