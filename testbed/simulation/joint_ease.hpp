// A diver's joints at a change of who moves them, and where one source jumps. Where another source
// begins with another posture, or one goes on elsewhere after a gap or faster than limbs move, the
// limbs come to it at a swimmer's pace: what is off decays without a jolt at either end, on top of
// the source's own motion. Without it they jump, and water that is struck by limbs throws the body
// about. Plain bytes, pure functions; any thread.
#pragma once

#include <array>
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

// The fastest that joints move by muscles, in air: 28.4 rad/s at the knee, the most of the legs,
// and 50 rad/s at the wrist, the most of all (Jessop and Pain 2016, Maximum velocities in flexion
// and extension actions for sport, Journal of Human Kinetics 50, 37). What a source moves a joint
// faster is a jump.
inline constexpr double kFastestLimb_rad_s = 28.4, kFastestWrist_rad_s = 50.0;
// Between two samples limbs go on for the time that passed: no less than this, since samples arrive
// in bursts, and no more, since in one step a body follows no farther without being thrown.
inline constexpr double kShortestWay_s = 1.0 / 60.0, kLongestWay_s = 1.0 / 30.0;
// A source that is silent for so long, and for kGapPeriods of its periods, begins anew.
inline constexpr double kGap_s = 0.1, kGapPeriods = 5.0;

// The sources of limbs, and the times between their samples. kPosed: arms that inverse kinematics
// bring to tracked hands, the hands' source. Each of their joints may turn as fast as a wrist: the
// elbow of an avatar whose arm is shorter than the wearer's gets straight all at once (a hand that
// leaves reach at 2 m/s turns it by 36 degrees in 1/72 s). Their jumps are other sources' where
// those jump in the same step, since trunk and tracked hands part there.
enum LimbSource : std::size_t { kBodySource, kHeadSource, kHandsSource, kPosed };
inline constexpr std::size_t kLimbSources = 3;  // that are watched for jumps
struct SourcePace {
  double since_s = 0.0, period_s = 0.0;  // since the newest sample; before it. 0: none yet

  static void fields(auto&& field, auto& self) {
    field("since_s", self.since_s);
    field("period_s", self.period_s);
  }
};

struct JointEase {
  // Source's joint from eased joint at the change: child's axes.
  diver::JointRotations off = diver::straight_joints();
  double lasts_s = 0.0, left_s = 0.0;  // left_s = 0: none
  std::uint64_t parts = 0;             // which the sources moved in the newest step, as bits
  std::array<SourcePace, kLimbSources> paces;

  static void fields(auto&& field, auto& self) {
    field("off", self.off);
    field("lasts_s", self.lasts_s);
    field("left_s", self.left_s);
    field("parts", self.parts);
    field("paces", self.paces);
  }
};

// Begins where joints are a jump from `last`, the joints of the step before; ends what still goes
// on where they are none. Unit quaternions; dt_s: of the step.
void begin_ease(JointEase& ease, const diver::JointRotations& last,
                const diver::JointRotations& joints, double dt_s);
// Finds the sources that jumped in this step, as bits of LimbSource. A source jumps if it has a new
// sample (its bit is in `fresh`) and one of its joints is farther off than limbs can move.
// source_of: the source of each joint. Called once a step, with `live`, the bits of sources that
// act.
using SourcesOfJoints = std::array<LimbSource, diver::kJoints>;
std::uint64_t note_jumps(JointEase& ease, const diver::JointRotations& last,
                         const diver::JointRotations& joints, const SourcesOfJoints& source_of,
                         std::uint64_t live, std::uint64_t fresh, double dt_s);
// The joints as eased in this step. Unchanged, to the bit, where nothing is left.
void step_ease(JointEase& ease, diver::JointRotations& joints, double dt_s);

}  // namespace neritic::testbed
