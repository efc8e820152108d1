// Blending of poses.
#include "engine/sim/snapshot.hpp"

#include <cmath>

namespace neritic::sim {

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
