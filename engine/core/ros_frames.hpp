// The one place where Neritic's axes become ROS's (REP 103) and back: the world east, north, up
// (ENU); bodies and sensors forward, left, up (FLU); cameras' optical frames right, down, forward;
// quaternions as x, y, z, w; yaw from east towards north. Pure functions; any thread.
#pragma once

#include <array>

#include "engine/core/marine_frames.hpp"

namespace neritic::ros {

// World axes x east, y up, z south.
inline Vec3 enu_from_world(const Vec3& v) {
  return {v.x, -v.z, v.y};
}
inline Vec3 world_from_enu(const Vec3& v) {
  return {v.x, v.z, -v.y};
}
// North, east, down; its own inverse.
inline Vec3 enu_from_ned(const Vec3& v) {
  return {v.y, v.x, -v.z};
}
// Forward, starboard, down; its own inverse.
inline Vec3 flu_from_marine(const Vec3& v) {
  return {v.x, -v.y, -v.z};
}
// For the program's bodies: starboard, up, back.
inline Vec3 flu_from_body(const Vec3& v) {
  return {-v.z, -v.x, v.y};
}
inline Vec3 body_from_flu(const Vec3& v) {
  return {-v.y, v.z, -v.x};
}
// Between two frames of a body, both forward, starboard, down; its own inverse.
inline Quat flu_from_marine(const Quat& q) {
  return {q.w, q.x, -q.y, -q.z};
}

// enu_from_flu of ned_from_marine: ENU is NED turned by half a turn about its horizontal diagonal,
// FLU the marine axes turned by half a turn about forward.
inline Quat enu_from_ned(const Quat& ned_from_marine) {
  constexpr double kHalf = 0.70710678118654752440;
  const Quat q = Quat(0.0, kHalf, kHalf, 0.0) * ned_from_marine * Quat(0.0, -1.0, 0.0, 0.0);
  return q.w < 0.0 ? -q : q;
}
inline Quat ned_from_enu(const Quat& enu_from_flu) {
  constexpr double kHalf = 0.70710678118654752440;
  return Quat(0.0, -kHalf, -kHalf, 0.0) * enu_from_flu * Quat(0.0, 1.0, 0.0, 0.0);
}
// For a body with the program's axes: x starboard, y up, z backwards.
inline Quat enu_from_body(const Quat& world_from_body) {
  return enu_from_ned(ned_from_world(world_from_body));
}
inline Quat body_from_enu(const Quat& enu_from_flu) {
  return world_from_ned(ned_from_enu(enu_from_flu));
}
// For a view (x right, y up, z backwards) as an optical frame: half a turn about x.
inline Quat enu_from_optical(const Quat& world_from_view) {
  constexpr double kHalf = 0.70710678118654752440;
  const Quat enu_from_world_axes(kHalf, kHalf, 0.0, 0.0);  // a quarter turn about east
  const Quat q = enu_from_world_axes * world_from_view * Quat(0.0, 1.0, 0.0, 0.0);
  return q.w < 0.0 ? -q : q;
}

inline std::array<double, 4> xyzw(const Quat& q) {
  return {q.x, q.y, q.z, q.w};
}

// Headings turn from north towards east; the result is in (-pi, pi]. Its own inverse.
inline double yaw_from_heading(double heading_rad) {
  const double yaw_rad = std::remainder(0.5 * kPi - heading_rad, 2.0 * kPi);
  return yaw_rad <= -kPi ? kPi : yaw_rad;
}

}  // namespace neritic::ros
