// The forces that a vehicle's thrusters hold: along each axis by itself or only with others,
// against weight and buoyancy. Failed thrusters are left out; thrust is what the control's own
// saturation gives (rov/allocation.hpp). Body axes forward, starboard, down. Pure functions; any
// thread.
#pragma once

#include <string>
#include <vector>

#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// A push along a direction of the body's axes, as control gets it from the thrusters at most, and
// what comes with it on the other axes: all of surge, sway, heave and yaw, and those of roll and
// pitch that the thrusters control; weight and buoyancy hold the others.
struct Push {
  double most = 0.0;    // N, N m
  double astray = 0.0;  // a unit of it
};
Push push_along(const PhysicsVehicle& vehicle, const rov::Vec6& direction);
// The push along a direction with the other axes at rest; 0 where there is none.
double most_along(const PhysicsVehicle& vehicle, const rov::Vec6& direction);
rov::Vec6 axis_of(std::size_t axis, double sign);

// A line each: axes that no thruster pushes, and those that thrusters push only together, with the
// tilt that this brings.
void add_axes(const PhysicsVehicle& vehicle, std::vector<std::string>& lines);
// A weight beside the lift that the thrusters do not balance, so that the vehicle tilts.
void add_trim(const PhysicsVehicle& vehicle, std::vector<std::string>& lines);
// Weight or buoyancy beyond the thrust along it.
void add_buoyancy(const PhysicsVehicle& vehicle, std::vector<std::string>& lines);

}  // namespace neritic::testbed
