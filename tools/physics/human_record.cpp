#include "tools/physics/human_record.hpp"

#include <algorithm>
#include <cmath>

#include "diver/frames.hpp"

namespace neritic::tools {
namespace {

// Deco gas counts while its tank still gives a full breath where it is switched to.
std::uint64_t gases_used_up(const PhysicsHuman& human, const diver::HumanState& state) {
  std::array<double, diver::kMaxTanks> ambient_pa{};
  const auto& gases = human.computer->settings().gases;
  for (std::size_t i = 0; i < std::min(gases.size(), ambient_pa.size()); ++i)
    ambient_pa[i] = diver::pressure_at(human.body, gases[i].switch_depth_m);
  return diver::empty_tanks(human.body, state.life.tanks, ambient_pa);
}

}  // namespace

HumanRecorder::HumanRecorder(const PhysicsWorld& world, double joints_s)
    : world_(world),
      joints_s_(joints_s),
      figures_(world.humans().size()),
      tracks_(world.humans().size()),
      joints_(world.humans().size()),
      last_ned_m_(world.humans().size(), Vec3(0.0)) {
  for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].nodes = world.humans()[i].nodes;
}

HumanRow HumanRecorder::row_of(std::size_t index,
                               const sim::Snapshot<PhysicsState>& snapshot) const {
  const PhysicsHuman& human = world_.humans()[index];
  const HumanPhysics& state = snapshot.state.humans[index];
  const diver::RootState& root = state.human.root;
  HumanRow row;
  row.time_s = snapshot.time_s;
  row.human = index;
  row.world_from_body = world_pose(root.position_ned_m, root.attitude);
  row.velocity = root.velocity;
  row.current_m_s = world_from_ned(world_.current_ned_m_s(root.position_ned_m, snapshot.time_s));
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
  row.lungs_m3 = state.human.life.lungs.volume_m3;
  row.net_weight_n = diver::net_weight_n(human.body, state.human);
  row.out_of_gas_s = state.human.life.lungs.unfed_s;
  row.gas = diver::read_gas(human.body, state.human);
  row.computer = human.computer->view(state.human.life.computer, gases_used_up(human, state.human));
  row.cns_percent = state.human.life.computer.oxygen.cns_percent;
  row.otu = state.human.life.computer.oxygen.otu;
  row.vitals = state.human.life.vitals;
  row.hash = snapshot.hash;
  return row;
}

void HumanRecorder::add(const sim::Snapshot<PhysicsState>& snapshot, bool row, bool tracks) {
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    const HumanPhysics& state = snapshot.state.humans[i];
    const diver::RootState& root = state.human.root;
    HumanFigures& figures = figures_[i];
    if (snapshot.step > 0) figures.path_m += glm::distance(root.position_ned_m, last_ned_m_[i]);
    last_ned_m_[i] = root.position_ned_m;
    figures.largest_speed_m_s =
        std::max(figures.largest_speed_m_s, glm::length(root.velocity.linear()));
    figures.deepest_m = std::max(figures.deepest_m, root.position_ned_m.z);
    figures.shallowest_m = std::min(figures.shallowest_m, root.position_ned_m.z);
    if (tracks) {
      const Pose pose = drawn_pose(state);
      tracks_[i].places.push_back({snapshot.time_s, pose.position_m});
      tracks_[i].attitudes.push_back({snapshot.time_s, pose.rotation});
      auto& keys = joints_[i].keys;
      if (keys.empty() || snapshot.time_s - keys.back().time_s > joints_s_ - 1e-9)
        keys.push_back(drawn_joints(world_.humans()[i], state, snapshot.time_s));
    }
    if (row) rows_.push_back(row_of(i, snapshot));
  }
}

void HumanRecorder::give_tracks(scene::Scene& scene) {
  for (std::size_t i = 0; i < world_.humans().size(); ++i) {
    scene::Object& object = scene.objects[world_.humans()[i].object];
    object.mount.track = std::move(tracks_[i]);
    object.node_motion = std::move(joints_[i]);
  }
}

}  // namespace neritic::tools
