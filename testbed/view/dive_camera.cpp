#include "testbed/view/dive_camera.hpp"

#include <algorithm>

#include "engine/scene/animation.hpp"

namespace neritic::testbed {
namespace {

constexpr double kTurn_rad_per_px = 0.0025;
constexpr double kStickTurn_rad_s = 1.5;  // of a stick held to its end
constexpr double kFastFactor = 4.0;
const Vec3 kFromSonar_m(0.0, 0.7, 1.8);  // of the view of a scene without cameras
constexpr double kSteepest_rad = radians(-35.0);
constexpr double kWheelFactor = 1.25;  // a click of the wheel
constexpr double kMinSpeed_m_s = 0.05, kMaxSpeed_m_s = 50.0;
constexpr double kMaxStep_s = 0.1;  // a hitch must not throw the camera across the scene

// Above what a sonar is mounted on, level, as far down as the sonar looks, but never steeply.
scene::Mount over(scene::Mount mount) {
  const auto level = [](const Quat& rotation) {
    const Vec3 ahead = rotation * Vec3(0.0, 0.0, -1.0);
    const double pitch = std::clamp(std::asin(std::clamp(ahead.y, -1.0, 1.0)), kSteepest_rad, 0.0);
    return from_yaw_pitch_roll(course_of(rotation), pitch, 0.0);
  };
  const Quat turn = level(mount.pose.rotation);
  mount.pose = {mount.pose.position_m + turn * kFromSonar_m, turn};
  if (!mount.track) return mount;
  for (auto& place : mount.track->places) place.position_m.y += kFromSonar_m.y;
  for (auto& attitude : mount.track->attitudes) attitude.rotation = level(attitude.rotation);
  return mount;
}

}  // namespace

Vec2 turn_rad_of(const DiveInput& input, double elapsed_s) {
  return input.look_px * kTurn_rad_per_px +
         input.look_rate * (kStickTurn_rad_s * std::min(elapsed_s, kMaxStep_s));
}

Pose level(const Pose& world_from_view) {
  const Vec3 ahead = world_from_view.rotation * Vec3(0, 0, -1);
  const Vec3 right = world_from_view.rotation * Vec3(1, 0, 0);
  const bool known = std::hypot(ahead.x, ahead.z) > 0.05;  // else only the right hand tells
  const double yaw_rad = known ? std::atan2(-ahead.x, -ahead.z) : std::atan2(-right.z, right.x);
  return {world_from_view.position_m, from_yaw_pitch_roll(yaw_rad, 0.0, 0.0)};
}

void FreeCamera::start_at(const Pose& world_from_view) {
  position_m_ = world_from_view.position_m;
  const Vec3 ahead = world_from_view.rotation * Vec3(0, 0, -1);
  const Vec3 right = world_from_view.rotation * Vec3(1, 0, 0);
  pitch_rad_ = std::clamp(std::asin(std::clamp(ahead.y, -1.0, 1.0)), -kMaxPitch_rad, kMaxPitch_rad);
  const bool level = std::hypot(ahead.x, ahead.z) > 0.05;  // else only the right hand tells
  yaw_rad_ = level ? std::atan2(-ahead.x, -ahead.z) : std::atan2(-right.z, right.x);
}

void FreeCamera::update(const DiveInput& input, double elapsed_s) {
  speed_m_s_ =
      std::clamp(speed_m_s_ * std::pow(kWheelFactor, input.wheel), kMinSpeed_m_s, kMaxSpeed_m_s);
  const double step_s = std::min(elapsed_s, kMaxStep_s);
  const Vec2 turn_rad = turn_rad_of(input, elapsed_s);
  yaw_rad_ = std::remainder(yaw_rad_ - turn_rad.x, 2.0 * kPi);
  pitch_rad_ = std::clamp(pitch_rad_ - turn_rad.y, -kMaxPitch_rad, kMaxPitch_rad);
  const Quat rotation = from_yaw_pitch_roll(yaw_rad_, pitch_rad_, 0.0);
  // Ahead and aside where the camera looks; up and down in the world.
  Vec3 direction = rotation * Vec3(input.move.x, 0.0, input.move.z) + Vec3(0, input.move.y, 0);
  const double length = glm::length(direction);
  if (length < 1e-9) return;
  const double speed_m_s = speed_m_s_ * (input.fast ? kFastFactor : 1.0);
  position_m_ += direction / std::max(length, 1.0) * (speed_m_s * step_s);
}

void FreeCamera::turn(double to_starboard_rad) {
  yaw_rad_ = std::remainder(yaw_rad_ - to_starboard_rad, 2.0 * kPi);
}

Pose FreeCamera::world_from_view() const {
  return {position_m_, from_yaw_pitch_roll(yaw_rad_, pitch_rad_, 0.0)};
}

double FreeCamera::heading_deg() const {
  const double heading = degrees(-yaw_rad_);
  return heading < 0.0 ? heading + 360.0 : heading;
}

double course_of(const Quat& world_from_body, double otherwise_rad) {
  const Vec3 ahead = world_from_body * Vec3(0.0, 1.0, -1.0);
  return std::hypot(ahead.x, ahead.z) > 0.05 ? std::atan2(-ahead.x, -ahead.z) : otherwise_rad;
}

scene::Camera camera_for(const scene::Scene& scene) {
  scene::Camera camera;
  camera.name = "diver's view";
  if (!scene.sonars.empty()) {
    camera.mount = over(scene.sonars.front().mount);
    return camera;
  }
  scene::Bounds bounds;
  for (const scene::Object& object : scene.objects) {
    if (object.model < 0) continue;
    const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
    const scene::Bounds own =
        scene::model_bounds(model, scene::evaluate_pose(model, object.clip, object.clip_offset_s));
    if (own.empty() || !is_finite(own.min) || !is_finite(own.max)) continue;
    const std::size_t copies = object.instance_count();
    for (std::size_t copy = 0; copy < copies; ++copy)
      for (int corner = 0; corner < 8; ++corner)
        bounds.add(Vec3(scene.world_from_copy(object, copy) *
                        Vec4((corner & 1 ? own.max : own.min).x, (corner & 2 ? own.max : own.min).y,
                             (corner & 4 ? own.max : own.min).z, 1.0)));
  }
  if (bounds.empty()) bounds = {Vec3(-1.0), Vec3(1.0)};
  const Vec3 middle = 0.5 * (bounds.min + bounds.max);
  // A large scene is mostly ground: from where a diver would be, not from where it fits the
  // picture.
  const double away_m = std::clamp(0.8 * glm::length(bounds.max - bounds.min), 1.0, 15.0);
  Vec3 eye = middle + glm::normalize(Vec3(0.5, 0.35, 1.0)) * away_m;
  if (middle.y < 0.0) eye.y = std::min(eye.y, -0.3);  // under water
  camera.mount.pose = look_at(eye, middle);
  return camera;
}

}  // namespace neritic::testbed
