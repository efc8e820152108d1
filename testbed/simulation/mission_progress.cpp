#include "testbed/simulation/mission_progress.hpp"

#include <algorithm>

namespace neritic::testbed {
namespace {

// Nearer by less does not count: a body that rocks at a wall comes no nearer.
constexpr double kNearer_m = 0.2;
// Of the way that its speed would make while it counts as stalled: currents and turns slow it.
constexpr double kLeastShare = 0.25;

}  // namespace

MissionProgress::MissionProgress(const PhysicsWorld& world)
    : world_(world), vehicles_(world.vehicles().size()), humans_(world.humans().size()) {}

void MissionProgress::go_on(Way& way, std::uint64_t goal, double off_m, double speed_m_s) {
  if (!way.led || way.goal != goal)
    way = {.led = true,
           .goal = goal,
           .begun_s = now_s_,
           .first_m = off_m,
           .off_m = off_m,
           .nearest_m = off_m,
           .nearest_s = now_s_};
  way.off_m = off_m;
  const double nearer_m = std::min(kNearer_m, kLeastShare * speed_m_s * kStalled_s);
  if (off_m > way.nearest_m - nearer_m) return;
  way.nearest_m = off_m;
  way.nearest_s = now_s_;
}

void MissionProgress::add(const sim::Snapshot<PhysicsState>& snapshot) {
  now_s_ = snapshot.time_s;
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    const PhysicsVehicle& vehicle = world_.vehicles()[i];
    const VehicleState& now = snapshot.state.vehicles()[i];
    if (!vehicle.mission || now.mission.piloted != 0 || vehicle.mission->holds(now.mission)) {
      vehicles_[i].led = false;
      continue;
    }
    const double speed_m_s = vehicle.mission->speed_m_s();
    go_on(vehicles_[i], now.mission.left,
          vehicle.mission->off_m(snapshot.state, now.body, snapshot.time_s, now.mission),
          speed_m_s == 0.0 ? kUsualSpeed_m_s : std::abs(speed_m_s));
  }
  for (std::size_t i = 0; i < humans_.size(); ++i) {
    const PhysicsHuman& human = world_.humans()[i];
    const HumanPhysics& now = snapshot.state.humans()[i];
    const std::size_t count = human.waypoints_ned_m.size();
    // Whose jacket a file inflates is carried off on purpose (assets/scenes/ascent.toml).
    const bool swims = count > 0 && (human.repeat || now.arrived < count) && !human.buttons;
    const GroupState& body = now.groups[static_cast<std::size_t>(DiverGroup::kBody)];
    if (!swims || acting(body) != Authority::kAutopilot) {
      humans_[i].led = false;
      continue;
    }
    go_on(humans_[i], now.arrived,
          glm::distance(now.human.root.position_ned_m, human.waypoints_ned_m[now.arrived % count]),
          human.speed_m_s);
  }
}

std::optional<double> MissionProgress::stalled_s(const Way& way) const {
  const double since_s = now_s_ - way.nearest_s;
  if (!way.led || since_s < kStalled_s - 1e-6) return std::nullopt;
  return since_s;
}

std::optional<double> MissionProgress::stalled_vehicle_s(std::size_t vehicle) const {
  const auto& mission = world_.vehicles()[vehicle].mission;
  if (!mission || mission->waypoint_count() == 0) return std::nullopt;
  return stalled_s(vehicles_[vehicle]);
}

std::optional<double> MissionProgress::stalled_human_s(std::size_t human) const {
  return stalled_s(humans_[human]);
}

std::optional<double> MissionProgress::off_place_m(std::size_t vehicle) const {
  const auto& mission = world_.vehicles()[vehicle].mission;
  const Way& way = vehicles_[vehicle];
  if (!mission || mission->waypoint_count() > 0 || !way.led || way.off_m <= kAtPlace_m)
    return std::nullopt;
  const double enough_s = 2.0 * way.first_m / kUsualSpeed_m_s + kSlack_s;
  if (now_s_ - way.begun_s < enough_s && !stalled_s(way)) return std::nullopt;
  return way.off_m;
}

}  // namespace neritic::testbed
