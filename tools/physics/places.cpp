#include "tools/physics/places.hpp"

#include "rov/frames.hpp"

namespace neritic::tools {

Place::Place(const scene::Scene& scene, const scene::Aim& aim,
             const std::vector<int>& vehicle_of_object) {
  if (aim.object < 0) {
    chain_.push_back({-1, {aim.point_m, Quat(1.0, 0.0, 0.0, 0.0)}});
    return;
  }
  for (int object = aim.object; object >= 0;) {
    const auto index = static_cast<std::size_t>(object);
    vehicle_ = vehicle_of_object[index];
    if (vehicle_ >= 0) return;
    chain_.push_back(scene.objects[index].mount);
    object = scene.objects[index].mount.object;
  }
}

Pose Place::at(const PhysicsState& state, double time_s) const {
  Pose pose;
  for (const scene::Mount& mount : chain_) pose = mount.pose_at(time_s) * pose;
  if (vehicle_ < 0) return pose;
  const rov::State& body = state.vehicles[static_cast<std::size_t>(vehicle_)].body;
  return rov::world_pose(body.position_ned_m, body.attitude) * pose;
}

Vec3 Place::velocity_m_s(const PhysicsState& state, double time_s) const {
  constexpr double kApart_s = 1e-3;
  const Vec3 along_track =
      (at(state, time_s + kApart_s).position_m - at(state, time_s - kApart_s).position_m) /
      (2.0 * kApart_s);
  if (vehicle_ < 0) return along_track;
  const rov::State& body = state.vehicles[static_cast<std::size_t>(vehicle_)].body;
  Pose body_from_this;
  for (const scene::Mount& mount : chain_) body_from_this = mount.pose_at(time_s) * body_from_this;
  const Vec3 arm_m = rov::ned_from_world(body_from_this.position_m);
  const Vec3 carried = body.velocity.linear() + glm::cross(body.velocity.angular(), arm_m);
  return along_track + rov::world_from_ned(body.attitude * carried);
}

}  // namespace neritic::tools
