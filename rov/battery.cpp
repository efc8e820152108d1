#include "rov/battery.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/math.hpp"
#include "rov/bounds.hpp"

namespace neritic::rov {
namespace {

double rest_v(const Battery& b, double charge) {
  return b.empty_v + (b.full_v - b.empty_v) * charge;
}
// Voltage and current at which the power leaves the terminals.
void load(const Battery& b, double power_w, BatteryState& state) {
  const double rest = rest_v(b, state.charge);
  const double most_w = b.resistance_ohm > 0.0 ? 0.25 * rest * rest / b.resistance_ohm : power_w;
  state.power_w = std::min(power_w, most_w);
  const double root =
      std::sqrt(std::max(rest * rest - 4.0 * b.resistance_ohm * state.power_w, 0.0));
  state.voltage_v = 0.5 * (rest + root);
  state.current_a = state.power_w / state.voltage_v;
}

}  // namespace

Status check_battery(const Battery& b) {
  const Bound bounds[] = {
      {"capacity_wh", b.capacity_wh, 0.01, 1e7}, {"empty_v", b.empty_v, 1.0, 1000.0},
      {"full_v", b.full_v, b.empty_v, 1000.0},   {"resistance_ohm", b.resistance_ohm, 0.0, 10.0},
      {"hotel_w", b.hotel_w, 0.0, 1e5},          {"propeller_m", b.propeller_m, 0.005, 10.0},
      {"efficiency", b.efficiency, 0.01, 1.0},   {"charge", b.charge, 0.0, 1.0}};
  return check_bounds("battery", bounds);
}

// The voltage falls evenly with the charge.
double capacity_ah(const Battery& b) {
  return b.capacity_wh / (0.5 * (b.full_v + b.empty_v));
}

double thruster_power_w(const Battery& b, std::span<const double> forces_n) {
  const double disc_m2 = 0.25 * kPi * b.propeller_m * b.propeller_m;
  const double scale = 1.0 / (b.efficiency * std::sqrt(2.0 * b.water_kg_m3 * disc_m2));
  double sum = 0.0;
  for (const double force : forces_n) {
    const double thrust = std::isfinite(force) ? std::abs(force) : 0.0;
    sum += thrust * std::sqrt(thrust);
  }
  return scale * sum;
}

BatteryState start_battery(const Battery& b) {
  BatteryState out{.charge = b.charge};
  out.empty = out.charge > 0.0 ? 0 : 1;
  load(b, out.empty != 0 ? 0.0 : b.hotel_w, out);
  return out;
}

BatteryState step_battery(const Battery& b, const BatteryState& state,
                          std::span<const double> forces_n, double dt_s) {
  BatteryState out = state;
  if (state.empty != 0) {
    load(b, 0.0, out);
    return out;
  }
  load(b, b.hotel_w + thruster_power_w(b, forces_n), out);
  out.charge = std::max(0.0, state.charge - out.current_a * dt_s / (3600.0 * capacity_ah(b)));
  if (out.charge == 0.0) out.empty = 1;
  return out;
}

double battery_left_s(const Battery& b, const BatteryState& state) {
  if (state.empty != 0) return 0.0;
  return 3600.0 * state.charge * capacity_ah(b) / std::max(state.current_a, 1e-9);
}

}  // namespace neritic::rov
