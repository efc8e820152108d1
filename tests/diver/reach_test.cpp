// Head and hands at tracked places: targets are eyes and hands of postures made at random, so that
// each can be reached and the forward kinematics are the judge.
#include "diver/reach.hpp"

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

}  // namespace
}  // namespace neritic::diver
