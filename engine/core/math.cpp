#include "engine/core/math.hpp"

namespace neritic {

Pose look_at(const Vec3& eye_m, const Vec3& target_m, const Vec3& up) {
  const Vec3 along = target_m - eye_m;
  const double length = glm::length(along);
  if (!(length > 0.0)) return {eye_m, Quat(1.0, 0.0, 0.0, 0.0)};
  const Vec3 z = -along / length;
  Vec3 x = glm::cross(up, z);
  if (glm::length(x) < 1e-9) x = glm::cross(Vec3(0.0, 0.0, -1.0), z);
  if (glm::length(x) < 1e-9) x = glm::cross(Vec3(1.0, 0.0, 0.0), z);
  x = glm::normalize(x);
  const Vec3 y = glm::cross(z, x);
  return {eye_m, glm::normalize(glm::quat_cast(Mat3(x, y, z)))};
}

Quat from_yaw_pitch_roll(double yaw_rad, double pitch_rad, double roll_rad) {
  return glm::angleAxis(yaw_rad, Vec3(0, 1, 0)) * glm::angleAxis(pitch_rad, Vec3(1, 0, 0)) *
         glm::angleAxis(roll_rad, Vec3(0, 0, 1));
}

Mat4 reversed_z_projection(const FrustumTangents& t, double near_m) {
  // clip = (x_ndc * w, y_ndc * w, near, w) with w = -z, x_ndc = -1 at left and 1 at right, and
  // Vulkan's y_ndc = -1 on top.
  const double width = t.right - t.left;
  const double height = t.top - t.bottom;
  Mat4 m(0.0);
  m[0][0] = 2.0 / width;
  m[2][0] = (t.right + t.left) / width;
  m[1][1] = -2.0 / height;
  m[2][1] = -(t.top + t.bottom) / height;
  m[3][2] = near_m;
  m[2][3] = -1.0;
  return m;
}

FrustumTangents tangents_from_fov(double vertical_fov_rad, double aspect) {
  const double t = std::tan(vertical_fov_rad * 0.5);
  return {-t * aspect, t * aspect, -t, t};
}

}  // namespace neritic
