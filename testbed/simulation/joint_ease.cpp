#include "testbed/simulation/joint_ease.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
  if (!(ease.left_s > 0.0)) ease = {.parts = ease.parts, .paces = ease.paces};
}

std::uint64_t note_jumps(JointEase& ease, const diver::JointRotations& last,
                         const diver::JointRotations& joints, const SourcesOfJoints& source_of,
                         std::uint64_t live, std::uint64_t fresh, double dt_s) {
  std::array<double, kLimbSources> way_s{};  // 0: began anew after a gap
  for (std::size_t i = 0; i < kLimbSources; ++i) {
    SourcePace& pace = ease.paces[i];
    if ((live >> i & 1) == 0) {
      pace = {};
      continue;
    }
    pace.since_s += dt_s;
    if ((fresh >> i & 1) == 0) continue;
    const bool gap =
        pace.period_s > 0.0 && pace.since_s > kGap_s && pace.since_s > kGapPeriods * pace.period_s;
    if (!gap) way_s[i] = std::clamp(pace.since_s, kShortestWay_s, kLongestWay_s);
    pace.period_s = std::exchange(pace.since_s, 0.0);
  }
  fresh &= live;
  if (fresh == 0) return 0;
  // Where limbs are still on their way, a jump is one of the joints as eased.
  JointEase on = ease;
  diver::JointRotations eased = joints;
  step_ease(on, eased, dt_s);
  std::uint64_t jumped = 0;
  bool arms = false;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const bool posed = source_of[i] == kPosed;
    const LimbSource source = posed ? kHandsSource : source_of[i];
    if ((fresh >> source & 1) == 0) continue;
    const bool fast =
        posed || i == diver::joint_of(diver::kLeftHand) || i == diver::joint_of(diver::kRightHand);
    const double most_rad = way_s[source] > 0.0
                                ? way_s[source] * (fast ? kFastestWrist_rad_s : kFastestLimb_rad_s)
                                : kJump_rad_s * dt_s;
    const Quat off = glm::conjugate(eased[i]) * last[i];
    if (!(angle_of(off) > most_rad)) continue;
    if (posed)
      arms = true;
    else
      jumped |= std::uint64_t{1} << source;
  }
  return arms && jumped == 0 ? std::uint64_t{1} << kHandsSource : jumped;
}

}  // namespace neritic::testbed
