// The postures of a motion suit and of a diver: 23 segments of MVN (wire axes: z up, x forward of a
// person who faces x, y to the left; a rotation is that from the posture with arms spread) and 16
// of diver/segments.hpp (at rest the arms hang). Pure functions; any thread.
#pragma once

#include "engine/net/mxtp_frames.hpp"
#include "testbed/samples/payloads.hpp"

namespace neritic::testbed {

// The segments of MVN, in its order; a wire's id is one more.
enum MvnSegment : std::size_t {
  kMvnPelvis,
  kMvnL5,
  kMvnL3,
  kMvnT12,
  kMvnT8,
  kMvnNeck,
  kMvnHead,
  kMvnRightShoulder,
  kMvnRightUpperArm,
  kMvnRightForearm,
  kMvnRightHand,
  kMvnLeftShoulder,
  kMvnLeftUpperArm,
  kMvnLeftForearm,
  kMvnLeftHand,
  kMvnRightUpperLeg,
  kMvnRightLowerLeg,
  kMvnRightFoot,
  kMvnRightToe,
  kMvnLeftUpperLeg,
  kMvnLeftLowerLeg,
  kMvnLeftFoot,
  kMvnLeftToe,
};

// The abdomen is half-way between L5 and L3, the thorax T8 (which carries the shoulders), the head
// Head; shoulders and toes belong to thorax and feet.
diver::JointRotations joints_of(const net::SuitFrame& frame);
// Wrists by the suit; fingers by gloves where the frame has them, else straight. A finger's flexion
// is the mean bend of its joints beyond the palm (three, of the thumb two).
HandJoints hands_of(const net::SuitFrame& frame, const diver::JointRotations& joints);

// The reverse, for simulators: what a suit and gloves would send of a diver whose body has that
// attitude (wire axes from body axes) and these joints. Places are those of a body of 1.78 m.
net::SuitFrame suit_frame(const diver::JointRotations& joints,
                          const std::array<double, 10>& flexion, const Quat& wire_from_body);

}  // namespace neritic::testbed
