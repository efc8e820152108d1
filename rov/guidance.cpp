#include "rov/guidance.hpp"

#include <algorithm>

namespace neritic::rov {
namespace {

// K_D / K_P of the default gains: where a setpoint that moved comes to stand this many seconds of
// way ahead, the controller's output does not jump.
constexpr double kBraking = 0.5;
// lean(): its integral, four times slower than the controller comes to a place; how near that
// place the controller's own integral does the rest; how slow a vehicle stands.
constexpr double kLeaning_1_s = 0.25;
constexpr double kNear_m = 0.1;
constexpr double kStands_m_s = 0.15;

// A velocity that the vehicle soon has.
Vec3 gathered(double speed_m_s, const Vec3& along, const State& state) {
  const double now_m_s = glm::dot(state.attitude * state.velocity.linear(), along);
  return std::min(speed_m_s, std::max(0.0, now_m_s) + kGather_m_s) * along;
}

}  // namespace

Setpoint go_to(Setpoint s, const Vec3& point) {
  s.position_ned_m = point;
  s.velocity_ned_m_s = Vec3(0.0);
  return s;
}

Setpoint go_to(Setpoint s, const State& state, const Vec3& from, const Vec3& point,
               double speed_m_s) {
  const double length = glm::distance(from, point);
  if (!(length > 0.0)) return go_to(s, point);
  const Vec3 along = (point - from) / length;
  const double flown = glm::dot(state.position_ned_m - from, along);
  const double left = length - flown;
  if (left <= kBraking * std::min(speed_m_s, kGather_m_s)) return go_to(s, point);
  s.position_ned_m = from + std::max(0.0, flown) * along;
  s.velocity_ned_m_s = gathered(std::min(speed_m_s, left / kBraking), along, state);
  return s;
}

Setpoint orbit(Setpoint s, const State& state, const Vec3& centre, double radius_m,
               double speed_m_s) {
  const Vec3 out = state.position_ned_m - centre;
  const double angle = out.x == 0.0 && out.y == 0.0 ? 0.0 : std::atan2(out.y, out.x);
  const Vec3 radial(std::cos(angle), std::sin(angle), 0.0);
  s.position_ned_m = centre + radius_m * radial;
  const Vec3 tangent(-radial.y, radial.x, 0.0);
  s.velocity_ned_m_s =
      gathered(std::abs(speed_m_s), std::copysign(1.0, speed_m_s) * tangent, state);
  return s;
}

Setpoint follow(Setpoint s, const Vec3& target, const Vec3& velocity, double heading_rad,
                const Vec3& offset_m) {
  s.position_ned_m = target + heading_attitude(heading_rad) * offset_m;
  s.velocity_ned_m_s = velocity;
  return s;
}

Setpoint stand_between(Setpoint s, const Vec3& a, const Vec3& b, double distance_m) {
  const double length = glm::distance(a, b);
  const double from_b = distance_m < 0.0 ? 0.5 * length : std::min(distance_m, length);
  if (length > 0.0) s = go_to(s, b + from_b / length * (a - b));
  return look_at(s, b);
}

Setpoint lean(Setpoint s, const State& state, double period_s, Vec3& lean_ned_m) {
  const Vec3 off = s.position_ned_m - state.position_ned_m;
  const Vec3 way = along(s.velocity_ned_m_s);
  const Vec3 moves = state.attitude * state.velocity.linear() - s.velocity_ned_m_s;
  const double off_m = glm::length(off);
  // Farther off, the pull is clipped: it has all the thrust that there is.
  if (off_m > kNear_m && off_m < kMostLean_m &&
      glm::length(moves - glm::dot(moves, way) * way) < kStands_m_s)
    lean_ned_m += kLeaning_1_s * period_s * off;
  if (const double length_m = glm::length(lean_ned_m); length_m > kMostLean_m)
    lean_ned_m *= kMostLean_m / length_m;
  s.position_ned_m += lean_ned_m;
  return s;
}

Setpoint look_at(Setpoint s, const Vec3& point, bool tilted) {
  const Vec3 to = point - s.position_ned_m;
  const double level = std::hypot(to.x, to.y);
  if (level < 1e-6) return s;  // above or below: any heading faces it
  s.attitude = heading_attitude(std::atan2(to.y, to.x));
  if (!tilted) return s;
  const double pitch = std::atan2(-to.z, level);
  s.attitude = s.attitude * Quat(std::cos(0.5 * pitch), 0.0, std::sin(0.5 * pitch), 0.0);
  return s;
}

Setpoint at_heading(Setpoint s, double heading_rad) {
  s.attitude = heading_attitude(heading_rad);
  return s;
}

Setpoint WaypointFollower::update(const State& state) {
  if (waypoints_.empty()) return stay(state);
  if (!done() &&
      glm::distance(state.position_ned_m, waypoints_[reached_].position_ned_m) < radius_m_)
    ++reached_;
  const Waypoint& to = waypoints_[std::min(reached_, waypoints_.size() - 1)];
  return at_heading(go_to(Setpoint{}, to.position_ned_m), to.heading_rad);
}

}  // namespace neritic::rov
