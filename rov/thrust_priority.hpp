// Control when the thrusters cannot give all: what holds the vehicle level comes first, and what
// pushes it gets the rest. Cutting the whole wrench by one factor would take the moments too, and a
// vehicle at full thrust would overturn. NED; body axes forward, starboard, down. Pure functions
// without allocation; any thread.
#pragma once

#include "rov/controller.hpp"

namespace neritic::rov {

// The largest share, from 0 to 1, of push that the thrusters can give on top of holding.
Vec6 with_room(const Vehicle& vehicle, const Allocator& allocator, const Vec6& holding,
               const Vec6& push);

// The moments of the wrench, plus the Munk moment v x M_A v that the water turns a moving vehicle
// broadside with (Fossen 2011, eq. 6.43) and that exceeds the gains, and as much of its force as
// the thrusters have room for beside these.
Vec6 level_first(const Vehicle& vehicle, const Allocator& allocator, const Vec6& wrench,
                 const State& state);

// control_inputs() with these priorities. level: for setpoints without a pilot. piloted: the
// setpoint is held in full, and its pilot's wrench gets the room that is left.
Inputs level_inputs(const Vehicle& vehicle, const Allocator& allocator, const ControlGains& gains,
                    const Setpoint& setpoint, const State& state, ControlState& control);
Inputs piloted_inputs(const Vehicle& vehicle, const Allocator& allocator, const ControlGains& gains,
                      const Setpoint& setpoint, const State& state, ControlState& control);

}  // namespace neritic::rov
