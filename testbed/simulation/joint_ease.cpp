#include "testbed/simulation/joint_ease.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::testbed {
namespace {

constexpr Quat kNoTurn(1.0, 0.0, 0.0, 0.0);
constexpr double kSteepest = 1.5;  // slope of smoothstep in its middle

double angle_of(const Quat& q) {
  return 2.0 * std::atan2(glm::length(Vec3(q.x, q.y, q.z)), std::abs(q.w));
}

}  // namespace

void begin_ease(JointEase& ease, const diver::JointRotations& last,
                const diver::JointRotations& joints, double dt_s) {
  ease.off = diver::straight_joints();
  double widest_rad = 0.0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Quat off = glm::normalize(glm::conjugate(joints[i]) * last[i]);
    const double angle_rad = angle_of(off);
    if (!(angle_rad > kJump_rad_s * dt_s)) continue;
    ease.off[i] = off;
    widest_rad = std::max(widest_rad, angle_rad);
  }
  ease.lasts_s = widest_rad > 0.0
                     ? std::max(kShortestEase_s, kSteepest * widest_rad / kFastestEase_rad_s)
                     : 0.0;
  ease.left_s = ease.lasts_s;
}

void step_ease(JointEase& ease, diver::JointRotations& joints, double dt_s) {
  if (!(ease.left_s > 0.0)) return;
  const double share = glm::smoothstep(0.0, ease.lasts_s, ease.left_s);
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (ease.off[i] != kNoTurn)
      joints[i] = glm::normalize(joints[i] * glm::slerp(kNoTurn, ease.off[i], share));
  ease.left_s -= dt_s;
  if (!(ease.left_s > 0.0)) ease = {.parts = ease.parts};
}

}  // namespace neritic::testbed
