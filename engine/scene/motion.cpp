#include "engine/scene/motion.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"

namespace neritic::scene {
namespace {

// Velocities of what floats or hangs on a joint are differences over twice this time.
constexpr double kDifference_s = 1e-3;

template <class PoseAt>
Motion motion_by_differences(double time_s, const PoseAt& pose_at) {
  const Pose before = pose_at(time_s - kDifference_s), after = pose_at(time_s + kDifference_s);
  Quat turn = after.rotation * glm::conjugate(before.rotation);
  if (turn.w < 0.0) turn = -turn;
  return {pose_at(time_s), (after.position_m - before.position_m) / (2.0 * kDifference_s),
          Vec3(turn.x, turn.y, turn.z) / kDifference_s};
}

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

Motion local_motion(const Mount& mount, double time_s) {
  if (mount.afloat)
    return motion_by_differences(time_s, [&](double t_s) { return floating(mount, t_s); });
  if (!mount.track) return {mount.pose};
  return {pose_at(*mount.track, time_s), velocity_at(*mount.track, time_s),
          angular_velocity_at(*mount.track, time_s)};
}

// The carrier of a thing; model: needed if the thing hangs on one of its joints.
struct Carrier {
  const Mount* mount;
  const Model* model;
  int clip;
  double clip_offset_s, clip_rate;
  Vec3 scale;
};

ModelPose posed(std::size_t object, const Model& model, int clip, double clip_s, double time_s,
                const SimulatedMotion* simulated) {
  if (simulated)
    if (auto pose = simulated->model_pose(object, model, time_s)) return std::move(*pose);
  return evaluate_pose(model, clip, clip_s);
}

Mat4 model_from_joint(std::size_t object, const Model& model, int joint, int clip, double clip_s,
                      double time_s, const SimulatedMotion* simulated) {
  if (simulated)
    if (const auto moved = simulated->model_from_node(object, model, joint, time_s)) return *moved;
  return evaluate_node(model, joint, clip, clip_s);
}

Motion joint_motion(std::size_t object, const Carrier& carrier, int joint, double time_s,
                    const SimulatedMotion* simulated) {
  NERITIC_CHECK(carrier.model, "joint {} of object {} without a model", joint, object);
  return motion_by_differences(time_s, [&](double t_s) {
    const double clip_s = carrier.clip_offset_s + t_s * carrier.clip_rate;
    return object_from_joint(
        model_from_joint(object, *carrier.model, joint, carrier.clip, clip_s, t_s, simulated),
        carrier.scale);
  });
}

// From the thing outwards, so that its pose is rounded as it always was, up to the world or to what
// the simulation moves. carrier_of(object): an object that carries.
template <class CarrierOf>
MotionAt motion_along(const Mount& mount, double time_s, const SimulatedMotion* simulated,
                      const CarrierOf& carrier_of) {
  MotionAt out{local_motion(mount, time_s)};
  int joint = mount.joint;
  for (int object = mount.object; object >= 0;) {
    const auto index = static_cast<std::size_t>(object);
    const Carrier carrier = carrier_of(index);
    if (joint >= 0)
      out.motion = joint_motion(index, carrier, joint, time_s, simulated) * out.motion;
    if (simulated)
      if (const auto moved = simulated->at(index, time_s))
        return {moved->motion * out.motion, moved->known, moved->predicted_s};
    out.motion = local_motion(*carrier.mount, time_s) * out.motion;
    joint = carrier.mount->joint;
    object = carrier.mount->object;
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

Pose object_from_joint(const Mat4& model_from_node, const Vec3& scale) {
  constexpr double kNoLength = 1e-9;
  Pose out{scale * Vec3(model_from_node[3]), Quat(1.0, 0.0, 0.0, 0.0)};
  Mat3 axes(model_from_node);
  for (int i = 0; i < 3; ++i) {
    const double length = glm::length(axes[i]);
    if (!(length > kNoLength)) return out;
    axes[i] /= length;
  }
  if (glm::determinant(axes) < 0.0) axes[0] = -axes[0];
  out.rotation = glm::normalize(glm::quat_cast(axes));
  return out;
}

CarriedThing::CarriedThing(const Scene& scene, const Mount& mount) : chain_{{mount}} {
  while (chain_.back().mount.object >= 0) {
    NERITIC_CHECK(chain_.size() <= scene.objects.size(), "{} mounts", chain_.size());
    const Object& by = scene.objects.at(static_cast<std::size_t>(chain_.back().mount.object));
    chain_.push_back({by.mount,
                      by.model >= 0 ? scene.models.at(static_cast<std::size_t>(by.model)) : nullptr,
                      by.clip, by.clip_offset_s, by.clip_rate, by.scale});
  }
}

MotionAt CarriedThing::at(double time_s, const SimulatedMotion* simulated) const {
  std::size_t next = 1;
  return motion_along(chain_.front().mount, time_s, simulated, [&](std::size_t) {
    const Link& link = chain_[next++];
    return Carrier{&link.mount,        link.model.get(), link.clip,
                   link.clip_offset_s, link.clip_rate,   link.scale};
  });
}

std::optional<MotionAt> MotionSource::simulated(std::size_t object, double time_s) const {
  return simulated_ ? simulated_->at(object, time_s) : std::nullopt;
}

MotionAt MotionSource::at(const Mount& mount, double time_s) const {
  const std::size_t objects = scene_->objects.size();
  std::size_t steps = 0;
  return motion_along(mount, time_s, simulated_, [&](std::size_t index) {
    NERITIC_CHECK(index < objects && steps++ < objects, "object {} of {}", index, objects);
    const Object& by = scene_->objects[index];
    const Model* model =
        by.model >= 0 ? scene_->models[static_cast<std::size_t>(by.model)].get() : nullptr;
    return Carrier{&by.mount, model, by.clip, by.clip_offset_s, by.clip_rate, by.scale};
  });
}

Pose MotionSource::world_from_object(std::size_t object, double time_s) const {
  if (const auto moved = simulated(object, time_s)) return moved->motion.pose;
  return world_from(scene_->objects[object].mount, time_s);
}

Pose MotionSource::world_from_joint(std::size_t object, int joint, double time_s) const {
  const Pose world_from = world_from_object(object, time_s);
  if (joint < 0) return world_from;
  const Object& of = scene_->objects[object];
  const Model& model = *scene_->models[static_cast<std::size_t>(of.model)];
  const double clip_s = of.clip_offset_s + time_s * of.clip_rate;
  return world_from *
         object_from_joint(
             model_from_joint(object, model, joint, of.clip, clip_s, time_s, simulated_), of.scale);
}

FollowedPlace MotionSource::place_of(std::size_t object, int joint, const Vec3& position_m,
                                     double time_s) const {
  if (simulated_)
    if (const auto place = simulated_->followed(object, joint, position_m, time_s)) return *place;
  return {world_from_joint(object, joint, time_s) * position_m};
}

ModelPose MotionSource::model_pose(std::size_t object, const Model& model, double time_s) const {
  const Object& of = scene_->objects[object];
  return posed(object, model, of.clip, of.clip_offset_s + time_s * of.clip_rate, time_s,
               simulated_);
}

}  // namespace neritic::scene
