// The body as 16 segments and 15 joints: names, order, who hangs on whom, left and right. Body axes
// of a diver: forward from the hips to the head (the way one swims), starboard, down out of the
// belly. With all joints at zero the body stands straight, arms along the sides, toes to the front
// (which is down in these axes), and all segments' axes are parallel. Constants; any thread.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "engine/core/math.hpp"

namespace neritic::diver {

// Parents come before their children.
enum Segment : std::size_t {
  kPelvis,
  kAbdomen,
  kThorax,
  kHead,
  kLeftUpperArm,
  kLeftForearm,
  kLeftHand,
  kRightUpperArm,
  kRightForearm,
  kRightHand,
  kLeftUpperLeg,
  kLeftLowerLeg,
  kLeftFoot,
  kRightUpperLeg,
  kRightLowerLeg,
  kRightFoot,
};
inline constexpr std::size_t kSegments = 16;
// Joint i connects segment i + 1 to its parent, at that segment's origin.
inline constexpr std::size_t kJoints = 15;

inline constexpr std::array<std::string_view, kSegments> kSegmentNames{
    "pelvis", "abdomen",     "thorax",      "head",   "upper_arm_l", "forearm_l",
    "hand_l", "upper_arm_r", "forearm_r",   "hand_r", "upper_leg_l", "lower_leg_l",
    "foot_l", "upper_leg_r", "lower_leg_r", "foot_r"};
inline constexpr std::array<Segment, kSegments> kParent{
    kPelvis,       kPelvis, kAbdomen,       kThorax,       kThorax, kLeftUpperArm,
    kLeftForearm,  kThorax, kRightUpperArm, kRightForearm, kPelvis, kLeftUpperLeg,
    kLeftLowerLeg, kPelvis, kRightUpperLeg, kRightLowerLeg};
// The same segment of the other side; itself on the trunk.
inline constexpr std::array<Segment, kSegments> kMirror{
    kPelvis,    kAbdomen,      kThorax,       kHead,     kRightUpperArm, kRightForearm,
    kRightHand, kLeftUpperArm, kLeftForearm,  kLeftHand, kRightUpperLeg, kRightLowerLeg,
    kRightFoot, kLeftUpperLeg, kLeftLowerLeg, kLeftFoot};

constexpr std::size_t joint_of(Segment segment) {
  return segment - 1;
}
constexpr Segment child_of(std::size_t joint) {
  return static_cast<Segment>(joint + 1);
}
// -1 on the left, 1 on the right, 0 on the trunk.
constexpr double side_of(Segment segment) {
  if (segment <= kHead) return 0.0;
  return segment <= kLeftHand || (segment >= kLeftUpperLeg && segment <= kLeftFoot) ? -1.0 : 1.0;
}

// parent_from_child of each joint.
using JointRotations = std::array<Quat, kJoints>;
// The same as angles: about starboard (y, flexion and extension), then about down (z, abduction),
// then about the segment's own forward axis (x, twist); right-handed, radians. At hip, knee,
// shoulder and elbow a positive y moves the limb to the front, at the ankle it lifts the toes; in
// the spine it bends backwards.
using JointAngles = std::array<Vec3, kJoints>;

inline constexpr JointRotations straight_joints() {
  JointRotations q{};
  for (Quat& joint : q) joint = Quat(1.0, 0.0, 0.0, 0.0);
  return q;
}

}  // namespace neritic::diver
