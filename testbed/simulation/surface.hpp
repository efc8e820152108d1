// The water's surface for a vehicle: what rises out of it is not buoyed up, and thrusters near it
// draw air and push less (rov/ventilation.hpp), above it nothing. The surface is level at the
// vehicle, head_m above still water; drag stays the water's. Pure function; any thread.
#pragma once

#include "rov/dynamics.hpp"

namespace neritic::testbed {

// Takes the buoyancy of what is above the water, and what accelerating water would pull it with,
// off inputs.wrench, in proportion to its share of the height from bottom_m to top_m above the
// origin (an upright box), at the centre of buoyancy. Scales the commands of thrusters near the
// surface, cut to their limits; the thrust follows by its lag. Below, inputs stay as they are.
// top_m > bottom_m.
void apply_surface(const rov::Vehicle& vehicle, double top_m, double bottom_m,
                   const rov::State& state, double head_m, rov::Inputs& inputs);

}  // namespace neritic::testbed
