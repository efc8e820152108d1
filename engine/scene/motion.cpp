#include "engine/scene/motion.hpp"

#include <algorithm>

#include "engine/core/check.hpp"

namespace neritic::scene {
namespace {

Motion local_motion(const Mount& mount, double time_s) {
  if (!mount.track) return {mount.pose};
  return {pose_at(*mount.track, time_s), velocity_at(*mount.track, time_s),
          angular_velocity_at(*mount.track, time_s)};
}

}  // namespace

Motion operator*(const Motion& a_from_b, const Motion& b_from_c) {
  const Quat& turn = a_from_b.pose.rotation;
  const Vec3 arm_m = turn * b_from_c.pose.position_m;
  return {a_from_b.pose * b_from_c.pose,
          a_from_b.velocity_m_s + glm::cross(a_from_b.angular_velocity_rad_s, arm_m) +
              turn * b_from_c.velocity_m_s,
          a_from_b.angular_velocity_rad_s + turn * b_from_c.angular_velocity_rad_s};
}

std::optional<MotionAt> MotionSource::simulated(std::size_t object, double time_s) const {
  return simulated_ ? simulated_->at(object, time_s) : std::nullopt;
}

// From the mount outwards, so that its pose is rounded as it always was.
MotionAt MotionSource::at(const Mount& mount, double time_s) const {
  MotionAt out{local_motion(mount, time_s)};
  const std::size_t objects = scene_->objects.size();
  std::size_t steps = 0;
  for (int object = mount.object; object >= 0;) {
    const auto index = static_cast<std::size_t>(object);
    NERITIC_CHECK(index < objects && steps++ < objects, "object {} of {}", index, objects);
    if (const auto moved = simulated(index, time_s))
      return {moved->motion * out.motion, moved->known, moved->predicted_s};
    const Mount& carrier = scene_->objects[index].mount;
    out.motion = local_motion(carrier, time_s) * out.motion;
    object = carrier.object;
  }
  return out;
}

Pose MotionSource::world_from_object(std::size_t object, double time_s) const {
  if (const auto moved = simulated(object, time_s)) return moved->motion.pose;
  return world_from(scene_->objects[object].mount, time_s);
}

ModelPose MotionSource::model_pose(std::size_t object, const Model& model, double time_s) const {
  if (simulated_)
    if (auto pose = simulated_->model_pose(object, model, time_s)) return std::move(*pose);
  const Object& of = scene_->objects[object];
  return evaluate_pose(model, of.clip, of.clip_offset_s + time_s * of.clip_rate);
}

}  // namespace neritic::scene
