#include "engine/scene/motion.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"

namespace neritic::scene {
namespace {

// Velocities of what floats are differences over twice this time.
constexpr double kFloatStep_s = 1e-3;

Pose floating(const Mount& mount, double time_s) {
  const Pose still = mount.pose_at(time_s);
  const Vec3 ahead = still.rotation * Vec3(0.0, 0.0, -1.0);
  const Vec3 fit = mount.afloat->waves.height_and_slopes({still.position_m.x, still.position_m.z},
                                                         mount.afloat->length_breadth_m,
                                                         std::atan2(ahead.x, -ahead.z), time_s);
  // The shortest turn of the vertical onto the normal of the fitted plane.
  const Vec3 normal = glm::normalize(Vec3(-fit.y, 1.0, -fit.z));
  const Quat tilt = glm::normalize(Quat(1.0 + normal.y, normal.z, 0.0, -normal.x));
  return {still.position_m + Vec3(0.0, fit.x, 0.0), tilt * still.rotation};
}

Motion floating_motion(const Mount& mount, double time_s) {
  const Pose before = floating(mount, time_s - kFloatStep_s),
             after = floating(mount, time_s + kFloatStep_s);
  Quat turn = after.rotation * glm::conjugate(before.rotation);
  if (turn.w < 0.0) turn = -turn;
  return {floating(mount, time_s), (after.position_m - before.position_m) / (2.0 * kFloatStep_s),
          Vec3(turn.x, turn.y, turn.z) / kFloatStep_s};
}

Motion local_motion(const Mount& mount, double time_s) {
  if (mount.afloat) return floating_motion(mount, time_s);
  if (!mount.track) return {mount.pose};
  return {pose_at(*mount.track, time_s), velocity_at(*mount.track, time_s),
          angular_velocity_at(*mount.track, time_s)};
}

// From the thing outwards, so that its pose is rounded as it always was, up to the world or to what
// the simulation moves. mount_of(object): of an object that carries.
template <class MountOf>
MotionAt motion_along(const Mount& mount, double time_s, const SimulatedMotion* simulated,
                      const MountOf& mount_of) {
  MotionAt out{local_motion(mount, time_s)};
  for (int object = mount.object; object >= 0;) {
    const auto index = static_cast<std::size_t>(object);
    if (simulated)
      if (const auto moved = simulated->at(index, time_s))
        return {moved->motion * out.motion, moved->known, moved->predicted_s};
    const Mount& carrier = mount_of(index);
    out.motion = local_motion(carrier, time_s) * out.motion;
    object = carrier.object;
  }
  return out;
}

}  // namespace

const char* name_of(Knowledge known) {
  switch (known) {
    case Knowledge::kExact:
      return "exact";
    case Knowledge::kBetween:
      return "between";
    case Knowledge::kPredicted:
      return "predicted";
    case Knowledge::kHeld:
      return "held";
  }
  return "";
}

CarriedThing::CarriedThing(const Scene& scene, const Mount& mount) : chain_{mount} {
  while (chain_.back().object >= 0) {
    NERITIC_CHECK(chain_.size() <= scene.objects.size(), "{} mounts", chain_.size());
    chain_.push_back(scene.objects.at(static_cast<std::size_t>(chain_.back().object)).mount);
  }
}

MotionAt CarriedThing::at(double time_s, const SimulatedMotion* simulated) const {
  std::size_t next = 1;
  return motion_along(chain_.front(), time_s, simulated,
                      [&](std::size_t) -> const Mount& { return chain_[next++]; });
}

std::optional<MotionAt> MotionSource::simulated(std::size_t object, double time_s) const {
  return simulated_ ? simulated_->at(object, time_s) : std::nullopt;
}

MotionAt MotionSource::at(const Mount& mount, double time_s) const {
  const std::size_t objects = scene_->objects.size();
  std::size_t steps = 0;
  return motion_along(mount, time_s, simulated_, [&](std::size_t index) -> const Mount& {
    NERITIC_CHECK(index < objects && steps++ < objects, "object {} of {}", index, objects);
    return scene_->objects[index].mount;
  });
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
