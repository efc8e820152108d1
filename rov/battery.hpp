// A vehicle's battery, the named option of its file: what its thrusters and its electronics draw,
// the voltage under that load, and the charge that is left. Pure functions; any thread.
//
// Model. A thruster of thrust T draws T^1.5 / (efficiency sqrt(2 rho A)): the power of an ideal
// disc of area A = pi D^2 / 4 (Froude), divided by all that motor, controller and propeller lose.
// With 0.31 and 76 mm that is within 15 % of the T200's published 205, 390 and 645 W at 36.4, 51.5
// and 65.7 N (Blue Robotics, 12, 16 and 20 V). The battery is a voltage that falls evenly with the
// charge, behind a resistance. Its voltage sets what a thrust table gives. Empty, it feeds no
// thruster any more. Not modelled: cold, age, cells that differ, a motor's draw when it turns
// without thrust.
#pragma once

#include <cstdint>
#include <span>

#include "engine/core/result.hpp"

namespace neritic::rov {

// The defaults are those of the BlueROV2's lithium-ion pack: 4 cells in series, 18 Ah.
struct Battery {
  double capacity_wh = 266.0;  // from full to empty, without load
  double full_v = 16.8, empty_v = 12.8;
  double resistance_ohm = 0.05;
  double hotel_w = 20.0;  // electronics, cameras and lamps, always
  double propeller_m = 0.076;
  double efficiency = 0.31;
  double charge = 1.0;  // at the start, of 1
  double water_kg_m3 = 1025.0;
};

struct BatteryState {
  double charge = 1.0;     // of 1
  double voltage_v = 0.0;  // at its terminals, in the last step
  double current_a = 0.0, power_w = 0.0;
  std::uint64_t empty = 0;  // 1: no thruster has power any more

  static void fields(auto&& field, auto& self) {
    field("charge", self.charge);
    field("voltage_v", self.voltage_v);
    field("current_a", self.current_a);
    field("power_w", self.power_w);
    field("empty", self.empty);
  }
};

// Errors name the value, what was found and what is accepted.
Status check_battery(const Battery& battery);

double capacity_ah(const Battery& battery);

// Electrical power of thrusters, W. Forces that are not finite count as 0.
double thruster_power_w(const Battery& battery, std::span<const double> forces_n);

// As it stands before the first step: only the electronics draw.
BatteryState start_battery(const Battery& battery);

// After dt_s with thrusters at these forces. More power than the resistance lets through gives what
// it lets through.
BatteryState step_battery(const Battery& battery, const BatteryState& state,
                          std::span<const double> forces_n, double dt_s);

// Time until it is empty at the power of the last step, s; 0: it is.
double battery_left_s(const Battery& battery, const BatteryState& state);

}  // namespace neritic::rov
