#include "testbed/view/run_numbers.hpp"

#include <cmath>
#include <limits>

#include "hud/numbers.hpp"
#include "rov/frames.hpp"
#include "testbed/instruments/instrument_data.hpp"

namespace neritic::testbed {
namespace {

constexpr NumberUnit kLengthUnit{"m", "ft", hud::kFoot_m},
    kVelocityUnit{"m/s", "ft/s", hud::kFoot_m};
constexpr NumberUnit kRiseUnit{"m/min", "ft/min", hud::kFoot_m};
constexpr NumberUnit kForceUnit{"N", "lbf", hud::kPoundForce_n};
constexpr NumberUnit kTankUnit{"bar", "psi", 1e-5 * hud::kPsi_pa},
    kVolumeUnit{"l", "pt", hud::kPint_l};
// The same in both.
constexpr NumberUnit kOxygenUnit{"bar"}, kMinutesUnit{"min"}, kRateUnit{"/min"}, kAngleUnit{"deg"},
    kShareUnit{"%"};
constexpr NumberUnit kMillisecondsUnit{"ms"};

}  // namespace

void RunNumbers::add(const std::string& name, const NumberUnit& unit, double value, bool down) {
  if (next_ == all_.size()) {
    all_.push_back({name, unit, down, value, {}});
    all_.back().kept.assign(kNumbersKept, std::numeric_limits<float>::quiet_NaN());
  }
  RunNumber& number = all_[next_++];
  number.newest = value;
  number.kept[(first_ + count_ - 1) % kNumbersKept] = static_cast<float>(value);
}

void RunNumbers::add_vehicles(const PhysicsWorld& world, const PhysicsState& state) {
  for (std::size_t i = 0; i < world.vehicles().size(); ++i) {
    const PhysicsVehicle& vehicle = world.vehicles()[i];
    const rov::State& body = state.vehicles()[i].body;
    add(vehicle.name + " depth", kLengthUnit, body.position_ned_m.z, true);
    add(vehicle.name + " speed", kVelocityUnit, glm::length(body.velocity.linear()));
    add(vehicle.name + " heading", kAngleUnit, degrees(rov::heading_of(body.attitude)));
    double thrust_n = 0.0;
    const auto forces = rov::thruster_forces(vehicle.vehicle, body, body.held);
    for (std::size_t k = 0; k < vehicle.vehicle.thruster_count; ++k)
      thrust_n += std::abs(forces[k]);
    add(vehicle.name + " thrust", kForceUnit, thrust_n);
  }
}

void RunNumbers::add_divers(const PhysicsWorld& world,
                            const sim::Snapshot<PhysicsState>& snapshot) {
  for (std::size_t i = 0; i < world.humans().size(); ++i) {
    const std::string& name = world.humans()[i].name;
    const hud::DiveData data = instrument_data(world, i, snapshot);
    const diver::RootState& root = snapshot.state.humans()[i].human.root;
    add(name + " depth", kLengthUnit,
        gauge_of(world.humans()[i], snapshot.state.humans()[i]).depth_m, true);
    add(name + " speed", kVelocityUnit, glm::length(root.velocity.linear()));
    add(name + " ascent", kRiseUnit, data.ascent_m_min);
    add(name + " ceiling", kLengthUnit, hud::standard_depth_m(data.ceiling_m, data.bar_per_m),
        true);
    add(name + " no-stop time", kMinutesUnit, data.no_stop_min);
    add(name + " time to surface", kMinutesUnit, data.to_surface_min);
    add(name + " tank", kTankUnit, 1e-5 * data.tank_pa);
    add(name + " gas left", kMinutesUnit, data.gas_min);
    add(name + " pO2", kOxygenUnit, data.po2_bar);
    add(name + " CNS", kShareUnit, data.cns_percent);
    add(name + " jacket", kVolumeUnit, 1e3 * data.jacket_m3);
    add(name + " net weight", kForceUnit, data.net_weight_n);
    add(name + " heart", kRateUnit, data.heart_bpm);
    add(name + " breath", kRateUnit, data.breath_bpm);
    add(name + " lungs", kVolumeUnit, 1e3 * data.lungs_m3);
  }
}

void RunNumbers::look(const PhysicsWorld& world, const sim::Snapshot<PhysicsState>& snapshot,
                      double frame_ms, double view_scale) {
  const double time_s = snapshot.time_s;
  if (time_s >= looked_s_ && time_s < looked_s_ + 1.0 / kNumbers_hz) return;
  if (time_s < looked_s_) first_ = count_ = 0;  // the run went back
  looked_s_ = time_s;
  if (count_ < kNumbersKept)
    ++count_;
  else
    first_ = (first_ + 1) % kNumbersKept;
  times_s_[(first_ + count_ - 1) % kNumbersKept] = time_s;
  // Samples older than a graph shows are dropped: its least and greatest values are of what is
  // seen.
  for (; age_s(0) > kNumbersShown_s; --count_) first_ = (first_ + 1) % kNumbersKept;
  next_ = 0;
  add_divers(world, snapshot);
  add_vehicles(world, snapshot.state);
  add("frame", kMillisecondsUnit, frame_ms);
  add("view's resolution", kShareUnit, 100.0 * view_scale);
}

}  // namespace neritic::testbed
