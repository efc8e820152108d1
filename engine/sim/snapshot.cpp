// Blending of snapshots: where a time lies, and poses.
#include "engine/sim/snapshot.hpp"

#include <algorithm>

namespace neritic::sim {

BlendShare blend_share(TimeNs previous_ns, TimeNs newest_ns, TimeNs time_ns,
                       TimeNs max_predict_ns) {
  if (time_ns == newest_ns) return {1.0, BlendKind::kExact};
  if (time_ns == previous_ns) return {0.0, BlendKind::kExact};
  if (time_ns < previous_ns) return {0.0, BlendKind::kHeld};
  // Nothing yet but the start: there is no line to follow.
  if (newest_ns <= previous_ns) return {1.0, BlendKind::kHeld};
  const TimeNs limit_ns = newest_ns + std::max<TimeNs>(max_predict_ns, 0);
  const TimeNs shown_ns = std::min(time_ns, limit_ns);
  const double share =
      static_cast<double>(shown_ns - previous_ns) / static_cast<double>(newest_ns - previous_ns);
  if (time_ns > limit_ns) return {share, BlendKind::kHeld};
  return {share, time_ns < newest_ns ? BlendKind::kInterpolated : BlendKind::kPredicted};
}

Pose blend_pose(const Pose& older, const Pose& newer, double share) {
  const Vec3 position_m = older.position_m + (newer.position_m - older.position_m) * share;
  // The turn between the two as an axis and an angle: unlike a weighted sum it can be continued.
  Quat turn = glm::conjugate(older.rotation) * newer.rotation;
  if (turn.w < 0.0) turn = -turn;
  const Vec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  if (sine == 0.0) return {position_m, newer.rotation};
  const double half_rad = std::atan2(sine, turn.w) * share;
  const Quat part(std::cos(half_rad), axis * (std::sin(half_rad) / sine));
  return {position_m, glm::normalize(older.rotation * part)};
}

}  // namespace neritic::sim
