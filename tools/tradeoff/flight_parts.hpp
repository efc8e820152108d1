// Parts that flights (physics_flights.hpp) are made of. One thread.
#pragma once

#include "tools/tradeoff/physics_flights.hpp"

namespace neritic::tools {

std::size_t holds_of(double seconds);
// At 20 Hz.
Loop loop_of(const rov::Vehicle& vehicle, rov::Guide guide);
// Water whose velocity changes with depth, place and time, evenly over 40 m and 40 s.
sim::Current turning_current();
// A BlueROV2 Heavy in fresh water over sand and before a wall, tilted.
Flight vehicle_among_things(const char* name, bool lag);
// Steps of 1 ms, those that touch halved until they err least.
void halved_truth(Flight& flight);

}  // namespace neritic::tools
