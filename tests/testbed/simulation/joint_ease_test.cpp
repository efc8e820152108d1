// Joints at a change of who moves them: limbs come to another posture at a swimmer's pace, and the
// body is not thrown about; a source that goes on where the limbs are is followed to the bit.
#include "testbed/simulation/joint_ease.hpp"

#include "diver/reach.hpp"
#include "engine/core/random.hpp"
#include "testbed/samples/riding.hpp"
#include "testbed/simulation/saved_state.hpp"
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

// The poses of hands that ride with the body, in a standing person's axes from the hips, at a rate.
struct TrackedHands {
  TestDive dive = dive_of(hover_text("hands = { from = \"headset\", hold_s = 1.0 }"));
  Device device{dive, "headset", "diver/hand_poses"};
  double hz = 60.0;
  int step = 0;

  void say(const Vec3& left_m, const Vec3& right_m, std::uint64_t tracked = 3) {
    if (step++ % static_cast<int>(240.0 / hz) != 0) return;
    const Quat ahead = turned(radians(80.0), Vec3(1, 0, 0));
    device.say(HandPoses{{Pose{left_m, ahead}, Pose{right_m, ahead}}, tracked | kHandsRide});
  }
  // How far the wanted wrist is from there.
  double off_m(bool right, const Vec3& place_m) const {
    const diver::Body& body = dive.world->humans()[0].body;
    const Vec3 wrist =
        diver::body_from_hand(diver::posture_of(body, diver_of(dive).human.held.joints, {}), right)
            .position_m;
    return glm::distance(Vec3(wrist.y, wrist.x, -wrist.z), place_m);
  }
  std::uint64_t jumps() const { return group(dive, DiverGroup::kHands).jumps; }
};
constexpr Vec3 kLeftPlace_m(-0.25, 0.35, -0.35), kRightPlace_m(0.25, 0.30, -0.35);

// Whole arms go there by inverse kinematics; the jump is no more than those of a suit.
TEST(JointEase, AHandThatIsTrackedElsewhereAllAtOnceIsEasedAndCounted) {
  for (const double hz : {20.0, 60.0, 240.0})
    for (const double gap_s : {0.0, 0.3}) {
      TrackedHands hands;
      hands.hz = hz;
      thrown_in(hands.dive, 3.0, [&] { hands.say(kLeftPlace_m, kRightPlace_m); });
      EXPECT_LT(hands.off_m(true, kRightPlace_m), 1e-6);
      EXPECT_EQ(hands.jumps(), 0u);
      hands.dive.run(gap_s);
      const Vec3 elsewhere_m(0.45, 0.85, 0.05);
      const Thrown thrown =
          thrown_in(hands.dive, 3.0, [&] { hands.say(kLeftPlace_m, elsewhere_m); });
      EXPECT_LT(thrown.joint_rad_s, 1.2 * kFastestEase_rad_s) << hz << ", " << gap_s;
      EXPECT_GT(thrown.joint_rad_s, 0.5 * kFastestEase_rad_s) << hz << ", " << gap_s;
      EXPECT_LT(hands.off_m(true, elsewhere_m), 1e-6) << hz << ", " << gap_s;
      EXPECT_LT(hands.off_m(false, kLeftPlace_m), 1e-6) << hz << ", " << gap_s;
      EXPECT_EQ(hands.jumps(), 1u) << hz << ", " << gap_s;
      EXPECT_EQ(group(hands.dive, DiverGroup::kHands).losses, 0u);
    }
}

// It comes and goes, each time elsewhere: another source, so no jump.
TEST(JointEase, AHandThatIsLostAndFoundAgainAndAgainIsEased) {
  TrackedHands hands;
  const std::array places{kRightPlace_m, Vec3(0.5, 0.9, 0.0), Vec3(-0.1, 0.45, -0.3),
                          Vec3(0.3, -0.1, 0.2)};
  Thrown thrown;
  for (int i = 0; i < 8; ++i) {
    const std::uint64_t tracked = i % 2 == 0 ? 3 : 1;
    const Vec3 place_m = places[static_cast<std::size_t>(i / 2)];
    const Thrown now = thrown_in(hands.dive, i % 3 == 0 ? 0.4 : 1.3,
                                 [&] { hands.say(kLeftPlace_m, place_m, tracked); });
    thrown.joint_rad_s = std::max(thrown.joint_rad_s, now.joint_rad_s);
    thrown.body_rad_s = std::max(thrown.body_rad_s, now.body_rad_s);
  }
  EXPECT_LT(thrown.joint_rad_s, 1.5 * kFastestEase_rad_s);
  EXPECT_LT(thrown.body_rad_s, 2.5);
  EXPECT_EQ(hands.jumps(), 0u);
}

// Ahead out of reach and back at up to 1.9 m/s, across the chest, over the head and behind the
// back.
TEST(JointEase, HandsThatMoveAsPeopleMoveThemAreFollowed) {
  for (const double hz : {20.0, 72.0, 240.0}) {
    TrackedHands hands;
    hands.hz = hz;
    const auto place = [](double time_s) {
      const double phase = 2.0 * kPi * 0.4 * time_s;
      return Vec3(0.25 - 0.35 * std::sin(0.5 * phase), 0.35 + 0.55 * std::sin(0.23 * phase),
                  -0.30 + 0.50 * std::sin(phase));
    };
    thrown_in(hands.dive, 3.0, [&] { hands.say(kLeftPlace_m, place(0.0)); });
    double widest_rad = 0.0;
    diver::JointRotations last = diver_of(hands.dive).human.held.joints;
    for (int step = 0; step < 12 * 240; ++step) {
      const Vec3 right_m = place(step / 240.0);
      hands.say(kLeftPlace_m, right_m);
      hands.dive.simulation->advance(1);
      ASSERT_EQ(diver_of(hands.dive).ease.left_s, 0.0) << hz << ", " << step;
      const diver::JointRotations& now = diver_of(hands.dive).human.held.joints;
      for (std::size_t i = 0; i < diver::kJoints; ++i)
        widest_rad = std::max(widest_rad, angle_between(last[i], now[i]));
      last = now;
    }
    // An elbow gets straight like the root of what is left to go.
    EXPECT_LT(degrees(widest_rad), 55.0 * std::sqrt(20.0 / hz)) << hz;
    EXPECT_EQ(hands.jumps(), 0u) << hz;
  }
}

// Past the direction behind the back in which no elbow has a side: it still swings there while the
// hand is where it is tracked, also in a run that goes on from a saved state.
TEST(JointEase, AnElbowThatSwingsGoesOnFromASavedState) {
  TrackedHands run, other;
  run.hz = other.hz = 240.0;
  const auto say = [&](TrackedHands& hands, int step) {
    const double along = std::clamp(0.002 * (step - 720), -0.15, 0.15);
    const Vec3 behind = glm::normalize(Vec3(-0.2 + along, -0.5, 0.84));
    hands.say(kLeftPlace_m, Vec3(0.19, 0.55, 0.0) + 0.4 * behind);
    hands.dive.simulation->advance(1);
  };
  constexpr int kSaved = 735, kEnd = 960;
  for (int step = 0; step < kSaved; ++step) say(run, step);
  const StateFormat format = other.dive.world->state_format();
  const auto bytes = encode_state(format, saved_state(*run.dive.simulation, format));
  const auto restored = parse_state(format, bytes, "dive.state");
  ASSERT_TRUE(restored.ok()) << restored.error().message;
  restore_state(*other.dive.simulation, *restored);
  double widest_rad = 0.0;
  for (int step = kSaved; step < kEnd; ++step) {
    const diver::JointRotations last = diver_of(run.dive).human.held.joints;
    say(run, step);
    say(other, step);
    ASSERT_EQ(run.dive.simulation->newest().hash, other.dive.simulation->newest().hash) << step;
    const diver::JointRotations& now = diver_of(run.dive).human.held.joints;
    for (std::size_t i = 0; i < diver::kJoints; ++i)
      widest_rad = std::max(widest_rad, angle_between(last[i], now[i]));
    EXPECT_EQ(diver_of(run.dive).ease.left_s, 0.0) << step;
  }
  EXPECT_GT(widest_rad, kFastestEase_rad_s / 240.0);
  EXPECT_LT(widest_rad, 2.0 * kFastestEase_rad_s / 240.0);
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
