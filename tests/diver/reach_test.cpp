// Head and hands at tracked places: targets are eyes and hands of postures made at random, so that
// each can be reached and the forward kinematics are the judge.
#include "diver/reach.hpp"

#include <functional>

#include "tests/diver/bodies.hpp"

namespace neritic::diver {
namespace {

double degrees_between(const Quat& a, const Quat& b) {
  const Quat q = glm::conjugate(a) * b;
  return degrees(2.0 * std::atan2(std::hypot(q.x, q.y, q.z), std::abs(q.w)));
}

// A posture that a person can take: the spine leans within its limits, elbows are hinges that
// twist.
JointRotations random_posture(HumanDraws& draw) {
  const auto in = [&](double low, double high) { return radians(draw.uniform(low, high)); };
  JointAngles angles{};
  for (const Segment spine : {kAbdomen, kThorax})
    angles[joint_of(spine)] = {in(-10, 10), in(-20, 20), in(-15, 15)};
  angles[joint_of(kHead)] = {in(-40, 40), in(-40, 40), in(-20, 20)};
  for (const bool right : {false, true}) {
    angles[joint_of(right ? kRightUpperArm : kLeftUpperArm)] = {in(-40, 40), in(-40, 130),
                                                                in(-60, 60)};
    angles[joint_of(right ? kRightForearm : kLeftForearm)] = {in(-70, 70), in(2, 148), 0.0};
    angles[joint_of(right ? kRightHand : kLeftHand)] = {0.0, in(-50, 50), in(-20, 20)};
  }
  return rotations_of(angles);
}

ReachTargets targets_of(const Body& body, const JointRotations& joints) {
  const Posture posture = posture_of(body, joints, {});
  const Pose eyes = body_from_eyes(body, posture);
  return {eyes.rotation,
          eyes.position_m,
          {body_from_hand(posture, false), body_from_hand(posture, true)}};
}

TEST(Reach, EyesAndHandsOfRandomPosturesAreMet) {
  const Body body = make_body({}).value();
  HumanDraws draw(7);
  double eyes_mm = 0.0, hands_mm = 0.0, turn_deg = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const ReachTargets targets = targets_of(body, random_posture(draw));
    const JointRotations start = i % 2 == 0 ? straight_joints() : random_posture(draw);
    const Posture got = posture_of(body, reach(body, start, targets), {});
    const Pose eyes = body_from_eyes(body, got);
    eyes_mm = std::max(eyes_mm, 1e3 * glm::distance(eyes.position_m, *targets.eyes_m));
    turn_deg = std::max(turn_deg, degrees_between(eyes.rotation, *targets.head));
    for (std::size_t hand = 0; hand < 2; ++hand) {
      const Pose there = body_from_hand(got, hand == 1);
      // The spine's own posture is left open, so a shoulder may lie elsewhere than it did, and a
      // nearly straight arm may be too short by that much.
      const double miss_mm = 1e3 * glm::distance(there.position_m, targets.hands[hand]->position_m);
      const Vec3 shoulder = got[hand == 1 ? kRightUpperArm : kLeftUpperArm].origin_m;
      const double asked_m = glm::distance(targets.hands[hand]->position_m, shoulder);
      const double arm_m = std::abs(body.segments[kLeftForearm].joint_m.x) +
                           std::abs(body.segments[kLeftHand].joint_m.x);
      if (asked_m < arm_m && asked_m > 0.16) hands_mm = std::max(hands_mm, miss_mm);
      turn_deg = std::max(turn_deg, degrees_between(there.rotation, targets.hands[hand]->rotation));
    }
  }
  EXPECT_LT(eyes_mm, 2.0);
  EXPECT_LT(hands_mm, 1e-6);
  EXPECT_LT(turn_deg, 1e-4);
}

// A spine that is bent by less than a degree may slump to the other side.
TEST(Reach, APostureThatMeetsItsTargetsKeepsItsElbows) {
  const Body body = make_body({}).value();
  HumanDraws draw(11);
  for (int i = 0; i < 200; ++i) {
    const JointRotations joints = random_posture(draw);
    const Posture was = posture_of(body, joints, {});
    const Posture is = posture_of(body, reach(body, joints, targets_of(body, joints)), {});
    for (const Segment elbow : {kLeftForearm, kRightForearm})
      EXPECT_LT(glm::distance(was[elbow].origin_m, is[elbow].origin_m), 0.006) << i;
  }
}

TEST(Reach, NoTargetChangesNoJoint) {
  HumanDraws draw(3);
  const JointRotations joints = random_posture(draw);
  const JointRotations same = reach(make_body({}).value(), joints, {});
  for (std::size_t i = 0; i < kJoints; ++i) EXPECT_EQ(joints[i], same[i]);
}

TEST(Reach, BeyondAPersonsReachTheArmPointsThereAndTheSpineLeansToItsLimit) {
  const Body body = make_body({}).value();
  for (const Vec3& far :
       {Vec3(0, 0, 3), Vec3(3, 0, 0), Vec3(-1e6, 2e6, 0), Vec3(0, -1e-3, 1e300)}) {
    ReachTargets targets;
    targets.head = Quat(1.0, 0.0, 0.0, 0.0);
    targets.eyes_m = far;
    targets.hands[1] = {far, Quat(1.0, 0.0, 0.0, 0.0)};
    const JointRotations joints = reach(body, straight_joints(), targets);
    const Posture posture = posture_of(body, joints, {});
    const Vec3 shoulder = posture[kRightUpperArm].origin_m;
    const Vec3 arm = posture[kRightHand].origin_m - shoulder;
    const double scale = std::max({std::abs(far.x), std::abs(far.y), std::abs(far.z)});
    EXPECT_GT(glm::dot(glm::normalize(arm), glm::normalize((far - shoulder) / scale)), 1.0 - 1e-9);
    EXPECT_NEAR(glm::length(arm),
                std::abs(body.segments[kRightForearm].joint_m.x) +
                    std::abs(body.segments[kRightHand].joint_m.x),
                1e-6);
    for (const Segment spine : {kAbdomen, kThorax})
      EXPECT_LE(degrees_between(joints[joint_of(spine)], Quat(1.0, 0.0, 0.0, 0.0)), 45.0 + 1e-6);
  }
}

TEST(Reach, AHandInTheShoulderOrAnArmLengthAwayIsFinite) {
  const Body body = make_body({}).value();
  const Posture posture = posture_of(body, straight_joints(), {});
  const Vec3 shoulder = posture[kLeftUpperArm].origin_m;
  const double arm_m = std::abs(body.segments[kLeftForearm].joint_m.x) +
                       std::abs(body.segments[kLeftHand].joint_m.x);
  for (const Vec3& way : {Vec3(0.0), Vec3(1e-300, 0, 0), Vec3(-arm_m, 0, 0), Vec3(arm_m, 0, 0),
                          Vec3(0, -arm_m, 0), Vec3(0, 0, arm_m * (1.0 + 1e-15))}) {
    ReachTargets targets;
    targets.hands[0] = {shoulder + way, Quat(0.0, 1.0, 0.0, 0.0)};
    for (const Quat& joint : reach(body, straight_joints(), targets))
      EXPECT_NEAR(glm::length(joint), 1.0, 1e-9);
  }
}

double arm_length_m(const Body& body) {
  return std::abs(body.segments[kLeftForearm].joint_m.x) +
         std::abs(body.segments[kLeftHand].joint_m.x);
}

// The same arm of the other side: starboard and port exchanged.
Vec3 other_side(const Vec3& v) {
  return {v.x, -v.y, v.z};
}
Pose other_side(const Pose& pose) {
  const Quat& q = pose.rotation;
  return {other_side(pose.position_m), Quat(q.w, -q.x, q.y, -q.z)};
}

// The widest turn of a joint between two steps of a path of the right hand, at(0) to at(1), from
// the shoulder; the elbow swings by at most most_swing_rad a step. The left hand goes the mirrored
// way, and its arm has to be the mirrored one.
double widest_turn_deg(const Body& body, int steps, double most_swing_rad,
                       const std::function<Pose(double)>& at) {
  const Vec3 shoulder = posture_of(body, straight_joints(), {})[kRightUpperArm].origin_m;
  BendSides sides;
  std::optional<JointRotations> last;
  double widest_deg = 0.0, unlike_deg = 0.0;
  for (int i = 0; i <= steps; ++i) {
    Pose hand = at(static_cast<double>(i) / steps);
    hand.position_m += shoulder;
    ReachTargets targets;
    targets.hands = {other_side(hand), hand};
    const JointRotations joints = reach(body, straight_joints(), targets, most_swing_rad, sides);
    const JointRotations mirror = mirrored(joints);
    for (std::size_t j = 0; j < kJoints; ++j) {
      if (last) widest_deg = std::max(widest_deg, degrees_between((*last)[j], joints[j]));
      unlike_deg = std::max(unlike_deg, degrees_between(mirror[j], joints[j]));
    }
    last = joints;
  }
  EXPECT_LT(unlike_deg, 1e-4);
  return widest_deg;
}
double widest_turn_deg(const Body& body, int steps, const std::function<Pose(double)>& at) {
  return widest_turn_deg(body, steps, 2.0 * kPi, at);
}

// From the hip along the chest to above the head, as a hand that begins to be tracked went: the
// shoulder lies beside the way. Half as long steps turn the joints half as far.
TEST(Reach, AHandThatPassesBeforeTheShoulderDoesNotThrowTheArmOver) {
  const Body body = make_body({}).value();
  for (const double before_m : {0.0, 0.02, 0.08, 0.16}) {
    const auto at = [&](double share) {
      return Pose{Vec3(-0.5 + share, 0.002, before_m), about(1, radians(150.0 * share))};
    };
    EXPECT_LT(widest_turn_deg(body, 2000, at), 1.0) << before_m;
    EXPECT_LT(widest_turn_deg(body, 4000, at), 0.5) << before_m;
  }
}

// In the plane of an arm that hangs: where the hand came into line with the upper arm of the
// posture before, the elbow turned over.
TEST(Reach, AnArmThatIsLiftedOverHeadDoesNotTurnOver) {
  const Body body = make_body({}).value();
  for (const double aside : {-0.02, 0.0, 0.02}) {
    const auto at = [&](double share) {
      const double angle_rad = radians(200.0 * share);
      return Pose{0.45 * Vec3(-std::cos(angle_rad), aside, std::sin(angle_rad)),
                  about(1, angle_rad)};
    };
    EXPECT_LT(widest_turn_deg(body, 1000, at), 1.0) << aside;
  }
}

// Out of reach and back, past the straight arm.
TEST(Reach, AHandThatLeavesReachAndComesBackKeepsTheElbowsSide) {
  const Body body = make_body({}).value();
  const double arm_m = arm_length_m(body);
  const auto at = [&](double share) {
    const double far_m = arm_m * (0.7 + 0.6 * std::sin(kPi * share));
    return Pose{far_m * glm::normalize(Vec3(0.2 * std::cos(2.0 * kPi * share), 0.3, 0.8)),
                about(1, radians(80.0))};
  };
  // The elbow gets straight like the root of what is left to go.
  EXPECT_LT(widest_turn_deg(body, 4000, at), 8.0);
  EXPECT_LT(widest_turn_deg(body, 16000, at), 4.0);
}

TEST(Reach, AHandGoesRoundTheShoulderInFront) {
  const Body body = make_body({}).value();
  HumanDraws draw(23);
  for (int i = 0; i < 200; ++i) {
    const bool right = i % 2 == 1;
    const Posture posture = posture_of(body, random_posture(draw), {});
    const Vec3 shoulder = posture[right ? kRightUpperArm : kLeftUpperArm].origin_m;
    const Vec3 from_m = shoulder + draw.vec3(0.4), to_m = shoulder + draw.vec3(0.4);
    const Vec3 from = round_shoulder(posture, right, from_m);
    const Vec3 to = round_shoulder(posture, right, to_m);
    EXPECT_LT(glm::distance(wrist_round_shoulder(posture, right, from), from_m), 1e-12);
    const double nearest_m =
        std::min(glm::distance(from_m, shoulder), glm::distance(to_m, shoulder));
    const Vec3 half_m = wrist_round_shoulder(posture, right, 0.5 * (from + to));
    EXPECT_GT(glm::distance(half_m, shoulder), nearest_m - 1e-12);
  }
  // From the hip to above the head, on either side, half-way it is ahead of the chest.
  const Posture posture = posture_of(body, straight_joints(), {});
  const Vec3 shoulder = posture[kLeftUpperArm].origin_m;
  const Vec3 half =
      wrist_round_shoulder(posture, false,
                           0.5 * (round_shoulder(posture, false, shoulder - Vec3(0.5, 0.0, 0.0)) +
                                  round_shoulder(posture, false, shoulder + Vec3(0.5, 0.0, 0.0))));
  EXPECT_GT(half.z - shoulder.z, 0.4);
}

// The forearm's twist changed its sign where the hand was turned about: it jumped by 160 degrees.
TEST(Reach, AHandThatIsTurnedRoundDoesNotTurnTheForearmAllAtOnce) {
  const Body body = make_body({}).value();
  for (const double pointing_rad : {0.0, 0.5, 2.0, 3.0}) {
    const auto at = [&](double share) {
      return Pose{Vec3(-0.1, 0.1, 0.35),
                  about(1, radians(90.0) + pointing_rad) * about(0, 2.0 * kPi * share)};
    };
    EXPECT_LT(widest_turn_deg(body, 4000, at), 1.0) << pointing_rad;
  }
}

// A millimetre beside the direction in which no elbow has a side, behind the back: there it would
// spin. It swings at its pace while the hand is where it is tracked.
TEST(Reach, TheElbowSwingsAtItsPaceWhereItHasNoSide) {
  const Body body = make_body({}).value();
  const Vec3 behind = -glm::normalize(Vec3(0.5, 0.2, 0.84));
  const Vec3 along = glm::cross(behind, Vec3(1, 0, 0)), beside = glm::cross(behind, along);
  const auto at = [&](double share) {
    return Pose{0.4 * glm::normalize(behind + 0.3 * (share - 0.5) * along + 0.002 * beside),
                about(1, 2.0)};
  };
  EXPECT_GT(widest_turn_deg(body, 1000, at), 15.0);
  EXPECT_LT(widest_turn_deg(body, 1000, radians(0.5), at), 1.0);
  BendSides sides;
  const Vec3 shoulder = posture_of(body, straight_joints(), {})[kRightUpperArm].origin_m;
  for (int i = 0; i <= 1000; ++i) {
    ReachTargets targets;
    targets.hands[1] = at(1e-3 * i);
    targets.hands[1]->position_m += shoulder;
    const Posture got =
        posture_of(body, reach(body, straight_joints(), targets, radians(0.5), sides), {});
    const Pose hand = body_from_hand(got, true);
    ASSERT_LT(glm::distance(hand.position_m, targets.hands[1]->position_m), 1e-9) << i;
    ASSERT_LT(degrees_between(hand.rotation, targets.hands[1]->rotation), 1e-4) << i;
  }
}

// The posture to start from nods, as a swimmer's does, about a straight spine; the head is lower
// than that has it. The spine slumped to the other side each time, at once.
TEST(Reach, ASpineThatIsBentToTheOtherSideComesRoundAtItsPace) {
  const Body body = make_body({}).value();
  ReachTargets targets;
  targets.head = Quat(1.0, 0.0, 0.0, 0.0);
  targets.eyes_m = body_from_eyes(body, posture_of(body, straight_joints(), {})).position_m -
                   Vec3(0.02, 0.0, 0.0);
  BendSides sides;
  std::optional<JointRotations> last;
  double widest_deg = 0.0, at_once_deg = 0.0, off_m = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    JointRotations start = straight_joints();
    start[joint_of(kAbdomen)] = about(1, 0.3 * std::sin(0.02 * i));
    const JointRotations joints = reach(body, start, targets, radians(0.5), sides);
    const Pose eyes = body_from_eyes(body, posture_of(body, joints, {}));
    off_m = std::max(off_m, glm::distance(eyes.position_m, *targets.eyes_m));
    const JointRotations at_once = reach(body, start, targets);
    for (std::size_t j = 0; last && j < kJoints; ++j) {
      widest_deg = std::max(widest_deg, degrees_between((*last)[j], joints[j]));
      at_once_deg = std::max(at_once_deg, degrees_between(at_once[j], joints[j]));
    }
    last = joints;
  }
  EXPECT_LT(off_m, 1e-3);
  EXPECT_GT(at_once_deg, 30.0);
  EXPECT_LT(widest_deg, 1.0);
}

// Soechting and Flanders 1989 (Errors in pointing are due to approximations in sensorimotor
// transformations, Journal of Neurophysiology 62, 595): people who point in the dark lift the upper
// arm by -4.0 + 1.10 R + 0.90 phi degrees from where it hangs, in a plane 13.2 + 0.86 chi + 0.11
// phi degrees to the side of the one ahead. R: cm from the shoulder; chi, phi: how far aside and
// up.
TEST(Reach, ElbowsAreWhereThoseOfPeopleWhoPointAre) {
  const Body body = make_body({}).value();
  const Vec3 shoulder = posture_of(body, straight_joints(), {})[kRightUpperArm].origin_m;
  const auto direction = [](double up_rad, double aside_rad) {
    return Vec3(std::sin(up_rad), std::cos(up_rad) * std::sin(aside_rad),
                std::cos(up_rad) * std::cos(aside_rad));
  };
  double squares = 0.0;
  int count = 0;
  for (const double r_cm : {30.0, 40.0, 50.0})
    for (double chi_deg = -30.0; chi_deg <= 70.0; chi_deg += 20.0)
      for (double phi_deg = -60.0; phi_deg <= 40.0; phi_deg += 20.0) {
        const double lifted_deg = -4.0 + 1.10 * r_cm + 0.90 * phi_deg;
        const double aside_deg = 13.2 + 0.86 * chi_deg + 0.11 * phi_deg;
        const Vec3 upper = direction(radians(lifted_deg - 90.0), radians(aside_deg));
        const Vec3 ahead = direction(radians(phi_deg), radians(chi_deg));
        const Vec3 wanted = upper - glm::dot(upper, ahead) * ahead;
        if (glm::length(wanted) < 0.1) continue;  // nearly straight
        ReachTargets targets;
        targets.hands[1] = {shoulder + 0.01 * r_cm * ahead, Quat(1.0, 0.0, 0.0, 0.0)};
        const Posture got = posture_of(body, reach(body, straight_joints(), targets), {});
        const Vec3 elbow = got[kRightForearm].origin_m - shoulder;
        const Vec3 is = elbow - glm::dot(elbow, ahead) * ahead;
        const double off_deg = degrees(
            std::acos(std::clamp(glm::dot(glm::normalize(is), glm::normalize(wanted)), -1.0, 1.0)));
        EXPECT_LT(off_deg, 45.0) << r_cm << " " << chi_deg << " " << phi_deg;
        squares += off_deg * off_deg;
        ++count;
      }
  EXPECT_GT(count, 90);
  EXPECT_LT(std::sqrt(squares / count), 16.0);
}

}  // namespace
}  // namespace neritic::diver
