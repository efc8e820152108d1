// The record of divers, made as a run goes: rows of numbers, and figures of the whole. One thread:
// the one that steps.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "testbed/simulation/human_readings.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// A diver at an instant.
struct HumanRow {
  double time_s = 0.0;
  std::size_t human = 0;
  Pose world_from_body;  // model axes of who swims: starboard, up, back
  Vec6 velocity;         // over ground; body axes forward, starboard, down
  Vec3 current_m_s{0.0};
  diver::SwimGoal goal;
  std::uint64_t arrived = 0, near_points = 0, touched_steps = 0, buttons = 0, tank = 0, refused = 0;
  double kick_hz = 0.0, limb_power_w = 0.0, oxygen_l_min = 0.0, reserve_share = 1.0, lungs_m3 = 0.0,
         net_weight_n = 0.0;
  diver::GasReading gas;
  std::array<double, diver::kMaxTanks> tank_pa{};  // of each
  double out_of_gas_s = 0.0;                       // since nothing came to breathe; 0 while it does
  diver::AscentGas ascent;                         // with the dive computer's view
  double cns_percent = 0.0, otu = 0.0;
  diver::VitalState vitals;
  std::uint64_t silent = 0;  // bits of groups of inputs whose source is not heard
  std::uint64_t hash = 0;    // of the whole state
};

// A change to another tank.
struct TankChange {
  double time_s = 0.0, depth_m = 0.0, po2_bar = 0.0;
  std::uint64_t from = 0, to = 0;
};

struct HumanFigures {
  double path_m = 0.0, largest_speed_m_s = 0.0, deepest_m = 0.0, shallowest_m = 1e9;
  std::vector<double> arrivals_s, misses_m;  // at its plan's waypoints, and how far off it is then
  // Dangers over the dive, noted once a second. How long the diver got no gas, in all and at a
  // stretch, since when and from which tank at first; 0: never.
  double out_of_gas_s = 0.0, out_of_gas_longest_s = 0.0, out_of_gas_from_s = 0.0;
  std::uint64_t out_of_gas_tank = 0;
  // By the dive computer: rate, the worst alarm and how long any lasted, and how far
  // above a ceiling.
  double fastest_ascent_m_min = 0.0, fastest_ascent_at_s = 0.0, ascent_alarm_s = 0.0;
  diver::AscentAlarm ascent_alarm = diver::AscentAlarm::kNone;
  double above_ceiling_m = 0.0, above_ceiling_from_s = 0.0;
  // The worst level; since when, and between which pressures, it was high or worse.
  diver::RiskLevel oxygen = diver::RiskLevel::kLow;
  double oxygen_from_s = 0.0, least_po2_bar = 0.0, most_po2_bar = 0.0;
  std::vector<TankChange> tank_changes;
};

HumanRow human_row(const PhysicsWorld& world, std::size_t human,
                   const sim::Snapshot<PhysicsState>& snapshot);

class HumanRecorder {
 public:
  explicit HumanRecorder(const PhysicsWorld& world);

  // Each step's result in turn, the start first.
  void add(const sim::Snapshot<PhysicsState>& snapshot);

  const std::vector<HumanFigures>& figures() const { return figures_; }

 private:
  void note_tank(std::size_t human, const sim::Snapshot<PhysicsState>& snapshot);
  void note_dangers(std::size_t human, const sim::Snapshot<PhysicsState>& snapshot);

  const PhysicsWorld& world_;
  std::vector<HumanFigures> figures_;
  std::vector<Vec3> last_ned_m_;
  std::vector<std::uint64_t> last_arrived_;
  std::vector<std::uint64_t> last_tank_;
  bool begun_ = false;
  double next_sample_s_ = 0.0;  // of the divers' computers
};

}  // namespace neritic::testbed
