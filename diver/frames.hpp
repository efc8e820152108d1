// The one place where a diver's axes meet the program's. Here: world north, east, down; body
// forward (to the head), starboard, down (out of the belly). Elsewhere: world x east, y up, z
// south; bodies x starboard, y up, z backwards: a level swimmer faces -z. Models of people
// stand: x right, y to the head, z out of the back. Pure functions; any thread.
#pragma once

#include "diver/segments.hpp"
#include "engine/core/marine_frames.hpp"

namespace neritic::diver {

using neritic::ned_from_world;
using neritic::world_from_ned;
using neritic::world_pose;

// From the axes in which a model of a person stands to the body axes of the program: it lies down
// on its belly.
inline Quat body_from_standing() {
  const double h = std::sqrt(0.5);
  return {h, -h, 0.0, 0.0};  // -90 degrees about x
}
// World pose of a standing person's model whose hips are where the body's are.
inline Pose standing_pose(const Vec3& position_ned_m, const Quat& ned_from_body) {
  const Pose body = world_pose(position_ned_m, ned_from_body);
  return {body.position_m, glm::normalize(body.rotation * body_from_standing())};
}
// Back again.
inline Quat ned_from_standing(const Quat& world_from_standing) {
  return ned_from_world(glm::normalize(world_from_standing * glm::conjugate(body_from_standing())));
}
// From body axes to those of a standing model, or back: (forward, starboard, down) are its
// (y, x, -z).
inline Vec3 standing_axes(const Vec3& v) {
  return {v.y, v.x, -v.z};
}
// A joint's rotation, parent_from_child, in the axes of a standing model.
inline Quat standing_joint(const Quat& joint) {
  return {joint.w, joint.y, joint.x, -joint.z};
}

// Rotations of a model's nodes that stands with its arms spread so far from the sides (0: hanging)
// and has all nodes' axes parallel then: what its joints need for a posture of ours.
inline JointRotations standing_joints(const JointRotations& joints, double arms_spread_rad) {
  JointRotations out;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const Segment segment = child_of(i);
    out[i] = standing_joint(joints[i]);
    if (segment < kLeftUpperArm || segment > kRightHand) continue;
    // About z, from the spread arm to the hanging one.
    const double half = -0.5 * side_of(segment) * arms_spread_rad;
    const Quat hang(std::cos(half), 0.0, 0.0, std::sin(half));
    const bool upper = segment == kLeftUpperArm || segment == kRightUpperArm;
    out[i] = upper ? out[i] * hang : glm::conjugate(hang) * out[i] * hang;
  }
  return out;
}

}  // namespace neritic::diver
