#include "tests/fakes/openxr/poses.hpp"

namespace neritic::fakes {

Pose operator*(const Pose& a_from_b, const Pose& b_from_c) {
  return {transform(a_from_b, b_from_c.position),
          glm::normalize(a_from_b.rotation * b_from_c.rotation)};
}

Pose inverse(const Pose& pose) {
  const glm::dquat back = glm::conjugate(pose.rotation);
  return {back * -pose.position, back};
}

glm::dvec3 transform(const Pose& pose, const glm::dvec3& point) {
  return pose.position + pose.rotation * point;
}

XrPosef to_xr(const Pose& pose) {
  const glm::quat q(pose.rotation);
  const glm::vec3 p(pose.position);
  return {{q.x, q.y, q.z, q.w}, {p.x, p.y, p.z}};
}

Pose from_xr(const XrPosef& pose) {
  const XrQuaternionf& q = pose.orientation;
  return {{pose.position.x, pose.position.y, pose.position.z},
          glm::normalize(glm::dquat(q.w, q.x, q.y, q.z))};
}

glm::dquat from_degrees(double yaw, double pitch, double roll) {
  return glm::angleAxis(glm::radians(yaw), glm::dvec3(0, 1, 0)) *
         glm::angleAxis(glm::radians(pitch), glm::dvec3(1, 0, 0)) *
         glm::angleAxis(glm::radians(roll), glm::dvec3(0, 0, 1));
}

Pose PoseTrack::at(double time_s) const {
  if (keys_.empty()) return {};
  auto next = keys_.upper_bound(time_s);
  if (next == keys_.begin()) return next->second;
  const auto last = std::prev(next);
  if (next == keys_.end()) return last->second;
  const double part = (time_s - last->first) / (next->first - last->first);
  return {glm::mix(last->second.position, next->second.position, part),
          glm::slerp(last->second.rotation, next->second.rotation, part)};
}

}  // namespace neritic::fakes
