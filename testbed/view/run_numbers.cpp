#include "testbed/view/run_numbers.hpp"

#include <cmath>
#include <limits>

#include "hud/numbers.hpp"
#include "rov/frames.hpp"
#include "testbed/instruments/instrument_data.hpp"

namespace neritic::testbed {

void RunNumbers::add(const std::string& name, const char* unit, double value, bool down) {
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
    add(vehicle.name + " depth", "m", body.position_ned_m.z, true);
    add(vehicle.name + " speed", "m/s", glm::length(body.velocity.linear()));
    add(vehicle.name + " heading", "deg", degrees(rov::heading_of(body.attitude)));
    double thrust_n = 0.0;
    const auto forces = rov::thruster_forces(vehicle.vehicle, body, body.held);
    for (std::size_t k = 0; k < vehicle.vehicle.thruster_count; ++k)
      thrust_n += std::abs(forces[k]);
    add(vehicle.name + " thrust", "N", thrust_n);
  }
}

void RunNumbers::add_divers(const PhysicsWorld& world,
                            const sim::Snapshot<PhysicsState>& snapshot) {
  for (std::size_t i = 0; i < world.humans().size(); ++i) {
    const std::string& name = world.humans()[i].name;
    const hud::DiveData data = instrument_data(world, i, snapshot);
    const diver::RootState& root = snapshot.state.humans()[i].human.root;
    add(name + " depth", "m", gauge_of(world.humans()[i], snapshot.state.humans()[i]).depth_m,
        true);
    add(name + " speed", "m/s", glm::length(root.velocity.linear()));
    add(name + " ascent", "m/min", data.ascent_m_min);
    add(name + " ceiling", "m", hud::standard_depth_m(data.ceiling_m, data.bar_per_m), true);
    add(name + " no-stop time", "min", data.no_stop_min);
    add(name + " time to surface", "min", data.to_surface_min);
    add(name + " tank", "bar", 1e-5 * data.tank_pa);
    add(name + " gas left", "min", data.gas_min);
    add(name + " pO2", "bar", data.po2_bar);
    add(name + " CNS", "%", data.cns_percent);
    add(name + " jacket", "l", 1e3 * data.jacket_m3);
    add(name + " net weight", "N", data.net_weight_n);
    add(name + " heart", "/min", data.heart_bpm);
    add(name + " breath", "/min", data.breath_bpm);
    add(name + " lungs", "l", 1e3 * data.lungs_m3);
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
  add("frame", "ms", frame_ms);
  add("view's resolution", "%", 100.0 * view_scale);
}

}  // namespace neritic::testbed
