#include "engine/core/motion.hpp"

namespace neritic {

Motion operator*(const Motion& a_from_b, const Motion& b_from_c) {
  const Quat& turn = a_from_b.pose.rotation;
  const Vec3 arm_m = turn * b_from_c.pose.position_m;
  return {a_from_b.pose * b_from_c.pose,
          a_from_b.velocity_m_s + glm::cross(a_from_b.angular_velocity_rad_s, arm_m) +
              turn * b_from_c.velocity_m_s,
          a_from_b.angular_velocity_rad_s + turn * b_from_c.angular_velocity_rad_s};
}

Motion predicted(const Motion& from, double ahead_s) {
  Motion out = from;
  out.pose.position_m += from.velocity_m_s * ahead_s;
  const double rate_rad_s = glm::length(from.angular_velocity_rad_s);
  if (rate_rad_s > 0.0)
    out.pose.rotation = glm::normalize(
        glm::angleAxis(rate_rad_s * ahead_s, from.angular_velocity_rad_s / rate_rad_s) *
        from.pose.rotation);
  return out;
}

Motion between(const Motion& a, const Motion& b, double share) {
  const auto mix = [share](const Vec3& from, const Vec3& to) { return from + (to - from) * share; };
  return {{mix(a.pose.position_m, b.pose.position_m),
           glm::normalize(glm::slerp(a.pose.rotation, b.pose.rotation, share))},
          mix(a.velocity_m_s, b.velocity_m_s),
          mix(a.angular_velocity_rad_s, b.angular_velocity_rad_s)};
}

}  // namespace neritic
