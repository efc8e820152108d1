// Joints at a change of who moves them: limbs come to another posture at a swimmer's pace, and the
// body is not thrown about; a source that goes on where the limbs are is followed to the bit.
#include "testbed/simulation/joint_ease.hpp"

#include "engine/core/random.hpp"
#include "testbed/samples/riding.hpp"
#include "tests/testbed/simulation/devices.hpp"

namespace neritic::testbed {
namespace {

const HumanPhysics& diver_of(const TestDive& dive) {
  return dive.state().humans()[0];
}

Quat turned(double angle_rad, const Vec3& axis) {
  return glm::angleAxis(angle_rad, axis);
}
double angle_between(const Quat& a, const Quat& b) {
  const Quat q = glm::conjugate(a) * b;
  return 2.0 * std::atan2(std::hypot(q.x, q.y, q.z), std::abs(q.w));
}

// Sits with one arm out: far from a hovering swimmer's posture, and not the same left and right.
BodyJoints sitting() {
  BodyJoints out;
  out.joints[diver::joint_of(diver::kLeftUpperArm)] = turned(radians(120.0), Vec3(1, 0, 0));
  for (const diver::Segment leg : {diver::kLeftUpperLeg, diver::kRightUpperLeg})
    out.joints[diver::joint_of(leg)] = turned(radians(90.0), Vec3(0, 1, 0));
  return out;
}

struct Thrown {
  double body_rad_s = 0.0, joint_rad_s = 0.0;
};

// The fastest that body and joints turned in these seconds; `each` is called before each step.
Thrown thrown_in(TestDive& dive, double seconds, const std::function<void()>& each) {
  Thrown out;
  for (int step = 0; step < static_cast<int>(240.0 * seconds); ++step) {
    each();
    dive.simulation->advance(1);
    const diver::HumanState& human = diver_of(dive).human;
    out.body_rad_s = std::max(out.body_rad_s, glm::length(human.root.velocity.angular()));
    for (const Vec3& rate : human.limbs.rate)
      out.joint_rad_s = std::max(out.joint_rad_s, glm::length(rate));
  }
  return out;
}

void expect_joints(const TestDive& dive, const BodyJoints& body) {
  for (std::size_t i = 0; i < diver::kJoints; ++i)
    EXPECT_LT(angle_between(diver_of(dive).human.limbs.rotation[i], body.joints[i]), 1e-6) << i;
}

// They turned it by 21 rad/s, three turns a second.
TEST(JointEase, ASuitThatTakesOverDoesNotThrowTheBody) {
  TestDive dive = dive_of(hover_text("body = \"suit\""));
  Device suit(dive, "suit", "diver/joints");
  dive.run(2.0);
  const Thrown thrown = thrown_in(dive, 3.0, [&] { suit.say(sitting()); });
  EXPECT_LT(thrown.joint_rad_s, 1.1 * kFastestEase_rad_s);
  EXPECT_GT(thrown.joint_rad_s, 0.5 * kFastestEase_rad_s);
  EXPECT_LT(thrown.body_rad_s, 2.5);
  expect_joints(dive, sitting());
  EXPECT_EQ(diver_of(dive).ease.left_s, 0.0);
}

TEST(JointEase, NorDoesOneThatComesBackElsewhereAfterAGap) {
  TestDive dive =
      dive_of(hover_text("body = { from = \"suit\", hold_s = 0.25, then = \"nobody\" }"));
  Device suit(dive, "suit", "diver/joints");
  for (int i = 0; i < 720; ++i) suit.say(BodyJoints{}), dive.simulation->advance(1);
  dive.run(1.0);
  ASSERT_EQ(group(dive, DiverGroup::kBody).phase, GroupPhase::kLost);
  const Thrown thrown = thrown_in(dive, 3.0, [&] { suit.say(sitting()); });
  EXPECT_LT(thrown.joint_rad_s, 1.1 * kFastestEase_rad_s);
  expect_joints(dive, sitting());
}

TEST(JointEase, AHeadThatBeginsAsideAndAHandThatIsLostAreEased) {
  TestDive dive = dive_of(hover_text("head = \"headset\", hands = \"headset\""));
  Device head(dive, "headset", "diver/head"), hands(dive, "headset", "diver/hand_poses");
  dive.run(2.0);
  const Pose aside{Vec3(0.0), turned(radians(70.0), Vec3(0, 1, 0))};
  const Pose hand{Vec3(0.4, 0.5, -0.3), turned(radians(80.0), Vec3(1, 0, 0))};
  std::uint64_t tracked = 3;
  const auto say = [&] {
    head.say(HeadPose{aside, kHeadRides});
    hands.say(HandPoses{{Pose{Vec3(-0.4, 0.5, -0.3), hand.rotation}, hand}, tracked | kHandsRide});
  };
  const Thrown begun = thrown_in(dive, 3.0, say);
  tracked = 2;
  const Thrown lost = thrown_in(dive, 3.0, say);
  EXPECT_LT(begun.joint_rad_s, 1.3 * kFastestEase_rad_s);
  EXPECT_LT(lost.joint_rad_s, 1.3 * kFastestEase_rad_s);
  EXPECT_GT(lost.joint_rad_s, 0.5);
}

// It goes on from where the limbs are, and moves them fast from then on.
TEST(JointEase, WhoGoesOnWhereTheLimbsAreIsFollowedToTheBit) {
  TestDive dive = dive_of(hover_text("body = \"suit\""));
  Device suit(dive, "suit", "diver/joints");
  dive.run(2.0);
  BodyJoints body{diver_of(dive).human.held.joints};
  Quat& elbow = body.joints[diver::joint_of(diver::kLeftForearm)];
  const Quat from = elbow;
  for (int step = 1; step <= 240; ++step) {
    elbow = glm::normalize(from * turned(0.8 * std::sin(10.0 * step / 240.0), Vec3(0, 1, 0)));
    suit.say(body);
    dive.simulation->advance(1);
    EXPECT_EQ(diver_of(dive).ease.left_s, 0.0) << step;
    const Quat& held = diver_of(dive).human.held.joints[diver::joint_of(diver::kLeftForearm)];
    EXPECT_LT(angle_between(held, elbow), 1e-12) << step;
  }
}

// The fastest turns of body and joints, and the jumps counted, when a suit of that rate goes on in
// another posture after that gap.
struct Jump {
  Thrown thrown;
  std::uint64_t jumps = 0, losses = 0;
};
Jump jump_of(double suit_hz, double gap_s) {
  TestDive dive = dive_of(hover_text("body = \"suit\""));
  Device suit(dive, "suit", "diver/joints");
  const int each = static_cast<int>(240.0 / suit_hz);
  int step = 0;
  const auto say = [&](const BodyJoints& joints) {
    return [&, joints] {
      if (step++ % each == 0) suit.say(joints);
    };
  };
  thrown_in(dive, 3.0, say({}));
  dive.run(gap_s);
  Jump out;
  out.thrown = thrown_in(dive, 3.0, say(sitting()));
  expect_joints(dive, sitting());
  const GroupState& body = group(dive, DiverGroup::kBody);
  out.jumps = body.jumps;
  out.losses = body.losses;
  return out;
}

// The stream jumps, or is silent for less than its hold and goes on elsewhere.
TEST(JointEase, ASourceThatJumpsDoesNotThrowTheBodyAndIsCounted) {
  for (const double suit_hz : {20.0, 60.0, 240.0})
    for (const double gap_s : {0.0, 0.3}) {
      const Jump jump = jump_of(suit_hz, gap_s);
      EXPECT_LT(jump.thrown.joint_rad_s, 1.1 * kFastestEase_rad_s) << suit_hz << ", " << gap_s;
      EXPECT_GT(jump.thrown.joint_rad_s, 0.5 * kFastestEase_rad_s) << suit_hz << ", " << gap_s;
      EXPECT_LT(jump.thrown.body_rad_s, 2.5) << suit_hz << ", " << gap_s;
      EXPECT_EQ(jump.jumps, 1u) << suit_hz << ", " << gap_s;
      EXPECT_EQ(jump.losses, 0u) << suit_hz << ", " << gap_s;
    }
}

// Elbows and knees faster than limbs go in water, by suits of several rates, with samples that are
// lost one by one.
TEST(JointEase, QuickMotionsPassUnchanged) {
  for (const int each : {1, 4, 8}) {
    TestDive dive = dive_of(hover_text("body = \"suit\""));
    Device suit(dive, "suit", "diver/joints");
    dive.run(2.0);
    BodyJoints body{diver_of(dive).human.held.joints};
    const auto say = [&](double time_s) {
      for (const diver::Segment segment : {diver::kLeftForearm, diver::kRightLowerLeg})
        body.joints[diver::joint_of(segment)] =
            turned(0.9 * (1.0 - std::cos(10.0 * time_s)),
                   Vec3(0, segment == diver::kLeftForearm ? 1.0 : -1.0, 0));
      suit.say(body);
    };
    for (int step = 0; step < 480; ++step) {  // comes to the first posture
      say(0.0);
      dive.simulation->advance(1);
    }
    ASSERT_EQ(diver_of(dive).ease.left_s, 0.0);
    std::uint64_t random = 7;
    bool lost = false;
    for (int step = 1; step <= 960; ++step) {
      random = mix64(random);
      if (step % each == 0) {
        lost = !lost && random % 4 == 0;
        if (!lost) say(step / 240.0);
      }
      dive.simulation->advance(1);
      ASSERT_EQ(diver_of(dive).ease.left_s, 0.0) << each << ", " << step;
      for (std::size_t i = 0; i < diver::kJoints; ++i)
        ASSERT_LT(angle_between(diver_of(dive).human.held.joints[i], body.joints[i]), 1e-12)
            << each << ", " << step;
    }
    EXPECT_EQ(group(dive, DiverGroup::kBody).jumps, 0u) << each;
  }
}

// A change while limbs are still on their way begins where they are.
TEST(JointEase, GoesOnFromWhereAChangeMeetsIt) {
  diver::JointRotations last = diver::straight_joints(), far = last;
  far[3] = turned(2.0, Vec3(0, 1, 0));
  JointEase ease;
  constexpr double kStep_s = 0.01;
  begin_ease(ease, last, far, kStep_s);
  EXPECT_NEAR(ease.lasts_s, 1.5 * 2.0 / kFastestEase_rad_s, 1e-9);
  double fastest_rad_s = 0.0;
  const auto step_to = [&](const diver::JointRotations& to) {
    diver::JointRotations joints = to;
    step_ease(ease, joints, kStep_s);
    for (std::size_t i = 0; i < joints.size(); ++i)
      fastest_rad_s = std::max(fastest_rad_s, angle_between(last[i], joints[i]) / kStep_s);
    last = joints;
  };
  for (int i = 0; i < 50; ++i) step_to(far);
  const diver::JointRotations back = diver::straight_joints();
  begin_ease(ease, last, back, kStep_s);
  for (int i = 0; i < 150; ++i) step_to(back);
  EXPECT_EQ(last, back);
  EXPECT_LT(fastest_rad_s, 1.001 * kFastestEase_rad_s);
  EXPECT_GT(fastest_rad_s, 0.9 * kFastestEase_rad_s);
}

}  // namespace
}  // namespace neritic::testbed
