// The speed of a propeller from the thrust that it gives, for what shows it. Pure function; any
// thread.
#pragma once

#include "rov/vehicle.hpp"

namespace neritic::rov {

// Revolutions a second at a thrust, in still water:
//   T = C_T rho D^4 n |n|
// with the thrust coefficient of a T200, 0.44: 36.4 N at some 3000 a minute with 12 V and 76 mm
// (Blue Robotics, T200 public performance data, September 2019). Positive where the thrust is along
// the thruster's direction; backwards the same coefficient. 0: the force is not finite, or
// propeller_m is 0. water_kg_m3: positive.
double propeller_hz(const Thruster& thruster, double force_n, double water_kg_m3);

}  // namespace neritic::rov
