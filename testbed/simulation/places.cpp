#include "testbed/simulation/places.hpp"

#include "diver/frames.hpp"

namespace neritic::testbed {
namespace {

// For an object that moves by physics: its pose, and its velocity over ground in its own marine
// axes.
struct Carrier {
  Pose world_from_object, world_from_body;
  Quat ned_from_body;
  Vec6 velocity;
};

Carrier vehicle_of(const rov::State& body) {
  const Pose pose = world_pose(body.position_ned_m, body.attitude);
  return {pose, pose, body.attitude, body.velocity};
}
// Drawn is a model that stands.
Carrier human_of(const diver::RootState& root) {
  return {diver::standing_pose(root.position_ned_m, root.attitude),
          world_pose(root.position_ned_m, root.attitude), root.attitude, root.velocity};
}

}  // namespace

Place::Place(const scene::Scene& scene, const scene::Aim& aim, const Movers& movers) {
  if (aim.object < 0) {
    chain_.push_back({-1, {aim.point_m, Quat(1.0, 0.0, 0.0, 0.0)}});
    return;
  }
  for (int object = aim.object; object >= 0;) {
    const auto index = static_cast<std::size_t>(object);
    vehicle_ = movers.vehicle_of_object[index];
    human_ = movers.human_of_object[index];
    if (vehicle_ >= 0 || human_ >= 0) return;
    chain_.push_back(scene.objects[index].mount);
    object = scene.objects[index].mount.object;
  }
}

Pose Place::at(const PhysicsState& state, double time_s) const {
  Pose pose;
  for (const scene::Mount& mount : chain_) pose = mount.pose_at(time_s) * pose;
  if (vehicle_ >= 0)
    return vehicle_of(state.vehicles()[static_cast<std::size_t>(vehicle_)].body).world_from_object *
           pose;
  if (human_ >= 0)
    return human_of(state.humans()[static_cast<std::size_t>(human_)].human.root).world_from_object *
           pose;
  return pose;
}

Quat Place::facing(const PhysicsState& state, double time_s) const {
  if (human_ < 0 || !chain_.empty()) return at(state, time_s).rotation;
  return human_of(state.humans()[static_cast<std::size_t>(human_)].human.root)
      .world_from_body.rotation;
}

Vec3 Place::velocity_m_s(const PhysicsState& state, double time_s) const {
  constexpr double kApart_s = 1e-3;
  const Vec3 along_track =
      (at(state, time_s + kApart_s).position_m - at(state, time_s - kApart_s).position_m) /
      (2.0 * kApart_s);
  if (vehicle_ < 0 && human_ < 0) return along_track;
  const Carrier carrier =
      vehicle_ >= 0 ? vehicle_of(state.vehicles()[static_cast<std::size_t>(vehicle_)].body)
                    : human_of(state.humans()[static_cast<std::size_t>(human_)].human.root);
  const Vec3 arm_world_m = at(state, time_s).position_m - carrier.world_from_body.position_m;
  const Vec3 arm_m = glm::conjugate(carrier.ned_from_body) * ned_from_world(arm_world_m);
  const Vec3 carried = carrier.velocity.linear() + glm::cross(carrier.velocity.angular(), arm_m);
  return along_track + world_from_ned(carrier.ned_from_body * carried);
}

}  // namespace neritic::testbed
