// Joints that bring the eyes and the hands to where they are tracked, from a posture near it: the
// spine leans, the neck turns, the arms bend at shoulder, elbow and wrist (inverse kinematics).
// Body axes forward, starboard, down. Exact within a person's reach; beyond it the arm points at
// the target and the spine leans as far as it can. Pure functions without allocation; any thread.
#pragma once

#include <array>
#include <optional>

#include "diver/kinematics.hpp"

namespace neritic::diver {

// The middle of the eyes from the neck's joint, as shares of the height: towards the crown and to
// the front. Measured behind the mask of assets/models/diver.glb.
inline constexpr double kEyesAbove = 0.0900;
inline constexpr double kEyesInFront = 0.0500;

// Limits of the joints that reach() moves: the normal ranges of the American Academy of Orthopaedic
// Surgeons. 90 degrees of the thoracolumbar spine, half of them at each of its two joints; 150 of
// the elbow; 80 of pronation and supination.
inline constexpr double kSpineBend = radians(45.0);
inline constexpr double kElbowBend = radians(150.0);
inline constexpr double kForearmTwist = radians(80.0);

// body_from_eyes and body_from_hand, in segment axes (kinematics.hpp). A hand's origin is its
// wrist.
struct ReachTargets {
  std::optional<Quat> head;                  // the head's attitude
  std::optional<Vec3> eyes_m;                // with head: where its eyes are
  std::array<std::optional<Pose>, 2> hands;  // left, right
};

// joints: of the posture to start from. It keeps what the targets leave open: the trunk where no
// eyes are named, the side to which an elbow points. Joints that the body's model does not move
// stay.
JointRotations reach(const Body& body, const JointRotations& joints, const ReachTargets& targets);

// The middle of the eyes and the wrists of a posture, with the attitude of head and hand.
Pose body_from_eyes(const Body& body, const Posture& posture);
Pose body_from_hand(const Posture& posture, bool right);

}  // namespace neritic::diver
