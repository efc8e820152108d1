// Joints that bring the eyes and the hands to where they are tracked, from a posture near it: the
// spine leans, the neck turns, the arms bend at shoulder, elbow and wrist (inverse kinematics).
// Body axes forward, starboard, down. Exact within a person's reach; beyond it the arm points at
// the target and the spine leans as far as it can. A hand that moves without a jump moves the arm
// without a jump, but within kElbowBend's distance of the shoulder, where no wrist comes. Pure
// functions without allocation; any thread.
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

// The sides to which joints between two bones point, from one step to the next: unit vectors across
// the way that the bones span. Elbows: across the way to the wrist, in the thorax's axes; the
// spine: across that to the neck, in the pelvis' axes, which are the body's. Zero: there was no
// target.
struct BendSides {
  std::array<Vec3, 2> elbows{};
  Vec3 spine{0.0};

  static void fields(auto&& field, auto& self) {
    field("elbows", self.elbows);
    field("spine", self.spine);
  }
};

// joints: of the posture to start from. It keeps what the targets leave open: the trunk where no
// eyes are named, the side to which an elbow points. Joints that the body's model does not move
// stay.
JointRotations reach(const Body& body, const JointRotations& joints, const ReachTargets& targets);
// The same for the next step: elbows and spine swing about their ways by at most most_swing_rad, so
// that none turns over at once: an elbow where the hand passes by the direction in which it has no
// side, behind the back; a spine that is bent to the other side in the posture to start from. Eyes
// and hands stay at their targets meanwhile.
JointRotations reach(const Body& body, const JointRotations& joints, const ReachTargets& targets,
                     double most_swing_rad, BendSides& sides);

// A wrist's place as seen from its shoulder, in numbers that may be mixed: on the way between two
// the hand goes round the shoulder, in front of it, where an arm goes. The first two turn away from
// in front, in radians up to pi together; the third is the distance in metres. Body axes.
Vec3 round_shoulder(const Posture& posture, bool right, const Vec3& wrist_m);
Vec3 wrist_round_shoulder(const Posture& posture, bool right, const Vec3& round);

// The middle of the eyes and the wrists of a posture, with the attitude of head and hand.
Pose body_from_eyes(const Body& body, const Posture& posture);
Pose body_from_hand(const Posture& posture, bool right);

}  // namespace neritic::diver
