#include "testbed/record/human_record.hpp"

#include <algorithm>
#include <cmath>

#include "diver/frames.hpp"

namespace neritic::testbed {

HumanRecorder::HumanRecorder(const PhysicsWorld& world)
    : world_(world),
      figures_(world.humans().size()),
      last_ned_m_(world.humans().size(), Vec3(0.0)),
      last_arrived_(world.humans().size()) {
  for (const PhysicsHuman& human : world.humans())
    last_tank_.push_back(human.start.human.held.tank);
}

HumanRow human_row(const PhysicsWorld& world, std::size_t index,
                   const sim::Snapshot<PhysicsState>& snapshot) {
  const PhysicsHuman& human = world.humans()[index];
  const HumanPhysics& state = snapshot.state.humans()[index];
  const diver::RootState& root = state.human.root;
  HumanRow row;
  row.time_s = snapshot.time_s;
  row.human = index;
  row.world_from_body = world_pose(root.position_ned_m, root.attitude);
  row.velocity = root.velocity;
  row.current_m_s =
      world_from_ned(world.water_ned(root.position_ned_m, snapshot.time_s).current_m_s);
  row.goal = swim_goal(human, state);
  row.arrived = state.arrived;
  row.near_points = state.contact.near_points;
  row.touched_steps = state.contact.touched_steps;
  row.tank = state.human.held.tank;
  row.buttons = state.human.held.buttons;
  row.refused = state.human.refused_inputs;
  row.kick_hz = state.swimmer.effort > 0.05 ? state.swimmer.frequency_hz : 0.0;
  row.limb_power_w = state.human.life.limb_power_w;
  row.oxygen_l_min = state.human.life.lungs.oxygen_l_min;
  row.reserve_share = diver::reserve_share(human.body.fitness, state.human.life.spent_j);
  row.lungs_m3 = state.human.life.lungs.volume_m3;
  row.net_weight_n = diver::net_weight_n(human.body, state.human);
  row.out_of_gas_s = state.human.life.lungs.unfed_s;
  row.gas = diver::read_gas(human.body, state.human);
  for (std::size_t i = 0; i < human.body.tank_count; ++i)
    row.tank_pa[i] = diver::tank_pressure(human.body, state.human.life.tanks, i);
  row.ascent = gas_for_ascent(human, state);
  row.cns_percent = state.human.life.computer.oxygen.cns_percent;
  row.otu = state.human.life.computer.oxygen.otu;
  row.vitals = state.human.life.vitals;
  row.silent = silent_groups(state.groups);
  row.hash = snapshot.hash;
  return row;
}

void HumanRecorder::note_tank(std::size_t index, const sim::Snapshot<PhysicsState>& snapshot) {
  const diver::HumanState& state = snapshot.state.humans()[index].human;
  const std::uint64_t from = last_tank_[index], to = state.held.tank;
  if (to == from) return;
  last_tank_[index] = to;
  const diver::Body& body = world_.humans()[index].body;
  const double depth_m = state.root.position_ned_m.z;
  const double oxygen = to < body.tank_count ? body.tanks[to].mix.oxygen : diver::kAir.oxygen;
  figures_[index].tank_changes.push_back(
      {snapshot.time_s, depth_m, 1e-5 * oxygen * diver::pressure_at(body, depth_m), from, to});
}

void HumanRecorder::note_dangers(std::size_t index, const sim::Snapshot<PhysicsState>& snapshot) {
  const PhysicsHuman& human = world_.humans()[index];
  const diver::HumanState& state = snapshot.state.humans()[index].human;
  const double now_s = snapshot.time_s;
  HumanFigures& f = figures_[index];
  if (const double unfed_s = state.life.lungs.unfed_s; unfed_s > 0.0) {
    if (f.out_of_gas_s == 0.0) {
      f.out_of_gas_from_s = 1e-6 * std::round(1e6 * (now_s - unfed_s));  // of sums of steps
      f.out_of_gas_tank = state.held.tank;
    }
    f.out_of_gas_s += diver::kComputerSample_s;
    f.out_of_gas_longest_s = std::max(f.out_of_gas_longest_s, unfed_s);
  }
  const diver::DiveComputerView view = human.computer->view(state.life.computer);
  if (view.ascent_m_min > f.fastest_ascent_m_min) {
    f.fastest_ascent_m_min = view.ascent_m_min;
    f.fastest_ascent_at_s = now_s;
  }
  f.ascent_alarm = std::max(f.ascent_alarm, view.alarm);
  if (view.alarm != diver::AscentAlarm::kNone) f.ascent_alarm_s += diver::kComputerSample_s;
  if (view.ceiling_violated) {
    if (f.above_ceiling_m == 0.0) f.above_ceiling_from_s = now_s;
    f.above_ceiling_m =
        std::max(f.above_ceiling_m, view.ceiling_m - state.life.computer.last.depth_m);
  }
  const diver::RiskLevel oxygen = state.life.vitals.risk.oxygen;
  f.oxygen = std::max(f.oxygen, oxygen);
  if (oxygen < diver::RiskLevel::kHigh) return;
  const double po2_bar = state.life.vitals.risk.oxygen_bar;
  if (f.most_po2_bar == 0.0) {
    f.oxygen_from_s = now_s;
    f.least_po2_bar = po2_bar;
  }
  f.least_po2_bar = std::min(f.least_po2_bar, po2_bar);
  f.most_po2_bar = std::max(f.most_po2_bar, po2_bar);
}

void HumanRecorder::add(const sim::Snapshot<PhysicsState>& snapshot) {
  if (!begun_) {  // at time 0, or at a restored state
    next_sample_s_ =
        diver::kComputerSample_s * std::ceil(snapshot.time_s / diver::kComputerSample_s - 1e-9);
    for (std::size_t i = 0; i < last_tank_.size(); ++i)
      last_tank_[i] = snapshot.state.humans()[i].human.held.tank;
  }
  const bool sample = snapshot.time_s >= next_sample_s_ - 1e-9;
  if (sample) next_sample_s_ += diver::kComputerSample_s;
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    const HumanPhysics& state = snapshot.state.humans()[i];
    const diver::RootState& root = state.human.root;
    HumanFigures& figures = figures_[i];
    if (begun_) figures.path_m += glm::distance(root.position_ned_m, last_ned_m_[i]);
    if (begun_ && state.arrived > last_arrived_[i]) {
      const std::vector<Vec3>& places = world_.humans()[i].waypoints_ned_m;
      figures.arrivals_s.push_back(snapshot.time_s);
      figures.misses_m.push_back(
          glm::distance(root.position_ned_m, places[(state.arrived - 1) % places.size()]));
    }
    last_arrived_[i] = state.arrived;
    last_ned_m_[i] = root.position_ned_m;
    figures.largest_speed_m_s =
        std::max(figures.largest_speed_m_s, glm::length(root.velocity.linear()));
    figures.deepest_m = std::max(figures.deepest_m, root.position_ned_m.z);
    figures.shallowest_m = std::min(figures.shallowest_m, root.position_ned_m.z);
    note_tank(i, snapshot);
    if (sample) note_dangers(i, snapshot);
  }
  begun_ = true;
}

}  // namespace neritic::testbed
