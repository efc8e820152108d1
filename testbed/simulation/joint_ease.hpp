// A diver's joints at a change of who moves them. Where another source begins with another posture,
// the limbs come to it at a swimmer's pace: what is off decays without a jolt at either end, on top
// of the source's own motion. Without it they jump, and water that is struck by limbs throws the
// body about. Plain bytes, pure functions; any thread.
#pragma once

#include <cstdint>

#include "diver/kinematics.hpp"

namespace neritic::testbed {

// At least as long, like hands that begin to be tracked (testbed/view/wearer.cpp).
inline constexpr double kShortestEase_s = 1.0;
// The fastest that a knee moves fins through water: 150 degrees a second (Gislason et al. 2022,
// Measurements on the external load acting on aquatic resistance fins during flexion/extension
// movements using a robotic joint, Frontiers in Physiology 13:1046502: 25 to 150).
inline constexpr double kFastestEase_rad_s = radians(150.0);
// No limb moves faster (diver/limb_filter.hpp): what a joint is farther off than this makes in a
// step is a jump.
inline constexpr double kJump_rad_s = 20.0;

struct JointEase {
  // Source's joint from eased joint at the change: child's axes.
  diver::JointRotations off = diver::straight_joints();
  double lasts_s = 0.0, left_s = 0.0;  // left_s = 0: none
  std::uint64_t parts = 0;             // which the sources moved in the newest step, as bits

  static void fields(auto&& field, auto& self) {
    field("off", self.off);
    field("lasts_s", self.lasts_s);
    field("left_s", self.left_s);
    field("parts", self.parts);
  }
};

// Begins where joints are a jump from `last`, the joints of the step before; ends what still goes
// on where they are none. Unit quaternions; dt_s: of the step.
void begin_ease(JointEase& ease, const diver::JointRotations& last,
                const diver::JointRotations& joints, double dt_s);
// The joints as eased in this step. Unchanged, to the bit, where nothing is left.
void step_ease(JointEase& ease, diver::JointRotations& joints, double dt_s);

}  // namespace neritic::testbed
