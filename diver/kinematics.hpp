// Where the segments are and how they move, from the joints. Body axes: forward (to the head),
// starboard, down (out of the belly), about the middle of the hips. Pure functions; any thread.
#pragma once

#include "diver/body.hpp"

namespace neritic::diver {

// Angular velocity of each joint's child against its parent, in the child's axes.
using JointRates = std::array<Vec3, kJoints>;

struct SegmentPose {
  Mat3 body_from_segment{1.0};
  Vec3 origin_m{0.0};
  // Against the body's axes, seen from them.
  Vec3 velocity_m_s{0.0}, angular_rad_s{0.0};
};
using Posture = std::array<SegmentPose, kSegments>;

Posture posture_of(const Body& body, const JointRotations& joints, const JointRates& rates);

// Joint rotations from angles (segments.hpp) and back: exact but for the sign of the quaternion;
// where the abduction is a right angle, twist counts as flexion.
JointRotations rotations_of(const JointAngles& angles);
JointAngles angles_of(const JointRotations& rotations);
// From every segment's attitude in any common axes, as a motion suit says them.
JointRotations rotations_of(const std::array<Quat, kSegments>& common_from_segment);

// A turn about one of the axes, 0 to 2.
Quat about(int axis, double angle_rad);

// Left and right exchanged.
JointRotations mirrored(const JointRotations& rotations);

// Body and gear without water, tanks empty.
struct MassProperties {
  double mass_kg = 0.0;
  Vec3 centre_m{0.0};
  Mat3 inertia_kg_m2{0.0};  // about the centre
};
MassProperties mass_properties(const Body& body, const Posture& posture);

}  // namespace neritic::diver
