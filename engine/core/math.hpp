// Vectors, poses and projections. World frame: right-handed, Y up, metres, still water at y = 0.
// View frame: x right (starboard), y up, z backwards. Transforms are named by both frames and read
// right to left: world_from_body * body_from_sensor. Positions on the CPU are double; the GPU gets
// floats relative to the camera. Pure functions; any thread.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace neritic {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec4 = glm::dvec4;
using Quat = glm::dquat;  // constructor order (w, x, y, z)
using Mat3 = glm::dmat3;
using Mat4 = glm::dmat4;
using Vec2f = glm::vec2;
using Vec3f = glm::vec3;
using Vec4f = glm::vec4;
using Mat4f = glm::mat4;

inline constexpr double kPi = std::numbers::pi;
constexpr double radians(double degrees) {
  return degrees * (kPi / 180.0);
}
constexpr double degrees(double radians) {
  return radians * (180.0 / kPi);
}

// S(p) x = p cross x.
inline Mat3 cross_matrix(const Vec3& p) {
  return Mat3(0.0, p.z, -p.y, -p.z, 0.0, p.x, p.y, -p.x, 0.0);  // columns
}

// The rotation of a quaternion of any length; none where there is no length to divide by.
inline Quat unit_or_identity(const Quat& q) {
  const double length = glm::length(q);
  return length > 1e-12 && std::isfinite(length) ? q / length : Quat(1.0, 0.0, 0.0, 0.0);
}

// A rigid transform: target_from_source. point_target = rotation * point_source + position_m.
struct Pose {
  Vec3 position_m{0.0};
  Quat rotation{1.0, 0.0, 0.0, 0.0};
};

inline Vec3 operator*(const Pose& a_from_b, const Vec3& point_b) {
  return a_from_b.rotation * point_b + a_from_b.position_m;
}
inline Pose operator*(const Pose& a_from_b, const Pose& b_from_c) {
  return {a_from_b.rotation * b_from_c.position_m + a_from_b.position_m,
          glm::normalize(a_from_b.rotation * b_from_c.rotation)};
}
inline Pose inverse(const Pose& a_from_b) {
  const Quat q = glm::conjugate(a_from_b.rotation);
  return {-(q * a_from_b.position_m), q};
}
inline Mat4 to_matrix(const Pose& pose) {
  Mat4 m = glm::mat4_cast(pose.rotation);
  m[3] = Vec4(pose.position_m, 1.0);
  return m;
}

// World_from_view pose of a camera at eye that looks at target; up defaults to +Y. Where the line
// of sight is parallel to up, -Z (or +X) stands in for it.
Pose look_at(const Vec3& eye_m, const Vec3& target_m, const Vec3& up = Vec3(0.0, 1.0, 0.0));

// Attitude of a body that faces -Z: yaw about +Y (positive turns to port), then pitch about the
// body's +X (positive looks up), then roll about the body's +Z (positive lifts starboard).
Quat from_yaw_pitch_roll(double yaw_rad, double pitch_rad, double roll_rad);

// Edges of an off-axis pinhole at unit distance: x from left to right, y from bottom to top.
struct FrustumTangents {
  double left = -1.0, right = 1.0, bottom = -1.0, top = 1.0;
};

// Reversed-Z with an infinite far plane: depth 1 at near_m, 0 at infinity, so planar metres =
// near_m / depth. Vulkan clip space (y down), view frame as above.
Mat4 reversed_z_projection(const FrustumTangents& tangents, double near_m);

// Tangents of a symmetric pinhole with the vertical field of view and the picture's aspect (w / h).
FrustumTangents tangents_from_fov(double vertical_fov_rad, double aspect);

inline bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
// Finite, and at most so long.
inline bool is_finite_within(const Vec3& v, double most) {
  return is_finite(v) && glm::length(v) <= most;
}

}  // namespace neritic
