// A headset's wearer as a diver: what is tracked and pressed becomes the diver's inputs.
#include "diver/jacket.hpp"
#include "engine/core/npy.hpp"
#include "testbed/samples/riding.hpp"
#include "testbed/view/dive_camera.hpp"
#include "tests/testbed/headset/headset_run.hpp"
#include "tests/testbed/simulation/devices.hpp"

namespace neritic::testbed {
namespace {

const std::string kPerson =
    "size 40 40\nhead 0 0 1.6 0 20\ngaze 0 10 0\nhands_seen no\n"
    "profile both oculus/touch_controller\ncontroller left 0 -0.2 1.2 -0.3\n";

class HeadsetWearer : public HeadsetRun {
 protected:
  void SetUp() override {
    HeadsetRun::SetUp();
    if (IsSkipped()) return;
    scene_ = dive_of(hover_text("")).scene;
    scene_.cameras.push_back(camera_for(scene_));
    NERITIC_ASSERT_OK(physics_, LivePhysics::create(scene_, LivePhysics::Pace::kPicture));
    with(*physics_);
  }
  const DiverInputs& inputs() const { return physics_->simulation().inputs().humans()[0]; }
  const HumanPhysics& state() const { return physics_->newest().state.humans()[0]; }

  scene::Scene scene_;
  std::unique_ptr<LivePhysics> physics_;
};

TEST_F(HeadsetWearer, HeadHandGazeAndButtonBecomeTheDiversInputs) {
  fakes::FakeHeadset fake(kPerson +
                          "real_time yes\nperiod 0.02\n"
                          "input /user/hand/left/input/trigger/value 0 1\n");
  // A gaze is a direction in the world when it was sampled: compared with the head at the same
  // time, since a slow machine's frames last until the body has turned on. The samples of a frame
  // arrive together, before the first step after it.
  std::vector<double> gazes_deg;
  std::array<bool, kDiverGroups> live{};
  std::optional<Vec3> gaze;
  Pose body;
  physics_->observe(
      [&](const sim::Snapshot<PhysicsState>& now) {
        const HumanPhysics& diver = now.state.humans()[0];
        if (gaze) {
          const Quat head = (body * inputs().head.world_from_head).rotation;
          const Vec3 seen = glm::conjugate(head) * *gaze;
          gazes_deg.push_back(degrees(std::atan2(-seen.x, -seen.z)));
        }
        gaze.reset();
        body = drawn_pose(diver);
        for (std::size_t i = 0; i < kDiverGroups; ++i)
          live[i] = live[i] || diver.groups[i].phase == GroupPhase::kLive;
      },
      [&](const Sample& sample) {
        if (sample.kind() == PayloadKind::kGaze)
          gaze = std::get<Gaze>(sample.payload).state.direction;
      });
  NERITIC_ASSERT_STATUS(dive(scene_, 90));  // a tracked hand comes to its place within a second
  const Pose head = inputs().head.world_from_head;
  for (const DiverGroup group :
       {DiverGroup::kHead, DiverGroup::kHands, DiverGroup::kGaze, DiverGroup::kButtons})
    EXPECT_TRUE(live[static_cast<std::size_t>(group)]) << name_of(group);
  EXPECT_EQ(inputs().buttons.pressed, diver::kInflate);
  // Tracked poses ride with the body.
  EXPECT_TRUE(inputs().head.placed & kHeadRides);
  // The gaze is 10 degrees to port of where the head looks.
  ASSERT_GE(gazes_deg.size(), 3u);
  for (const double gaze_deg : gazes_deg) EXPECT_NEAR(gaze_deg, 10.0, 0.5);
  // The wrist is 0.08 m from the grip, in the stage; the head is turned by 20 degrees there.
  ASSERT_EQ(inputs().hand_poses.tracked, 1u | kHandsRide);
  const Vec3 wrist = inverse(head) * inputs().hand_poses.world_from_hand[0].position_m;
  const Vec3 expected =
      from_yaw_pitch_roll(radians(-20.0), 0.0, 0.0) * Vec3(-0.2, -0.4 + 0.08, -0.3);
  EXPECT_LT(glm::distance(wrist, expected), 1e-3);
}

// From the tracker's measurement to the stream: both on this computer's clock.
TEST_F(HeadsetWearer, AGazeSampleIsInTheStreamInLessThanAFrame) {
  constexpr double kPeriod_s = 0.1;
  fakes::FakeHeadset fake(kPerson +
                          fmt::format("real_time yes\nperiod {}\ngaze_period 0.005\n", kPeriod_s));
  std::vector<double> delays_s, arrived_s;
  physics_->observe({}, [&](const Sample& sample) {
    if (sample.kind() != PayloadKind::kGaze) return;
    const auto [captured_ns, arrived_ns] =
        std::pair(sample.header.captured_ns, sample.header.arrived_ns);
    delays_s.push_back(1e-9 * static_cast<double>(arrived_ns - captured_ns));
    arrived_s.push_back(1e-9 * static_cast<double>(arrived_ns));
  });
  NERITIC_ASSERT_STATUS(dive(scene_, 12));
  ASSERT_GE(delays_s.size(), 8u);
  std::ranges::sort(delays_s);
  EXPECT_GE(delays_s.front(), 0.0);
  // A slow machine's frames last longer. A quarter may be late: what else the machine does stops
  // this thread.
  const double frame_s = std::max(kPeriod_s, (arrived_s.back() - arrived_s.front()) /
                                                 static_cast<double>(arrived_s.size() - 1));
  EXPECT_LT(delays_s[delays_s.size() * 3 / 4], frame_s);
}

// Frames of 1.2 s, with a simulation that goes on meanwhile.
TEST_F(HeadsetWearer, SeldomFramesAreNoSilence) {
  fakes::FakeHeadset fake(kPerson + "real_time yes\nperiod 1.2\n");
  NERITIC_ASSERT_OK(physics_, LivePhysics::create(scene_, LivePhysics::Pace::kClock));
  with(*physics_);
  NERITIC_ASSERT_STATUS(dive(scene_, 4));
  physics_->stop();
  const GroupState& head =
      physics_->newest().state.humans()[0].groups[static_cast<std::size_t>(DiverGroup::kHead)];
  EXPECT_EQ(head.phase, GroupPhase::kLive);
  EXPECT_LE(head.losses, 1u);  // before the first such frames
}

// A runtime whose time hardly moves: by its frames the half second would last for 50 000 of them.
TEST_F(HeadsetWearer, ADiveOfSoManySecondsEndsThoughTheRuntimesTimeStands) {
  fakes::FakeHeadset fake("size 16 16\nperiod 0.00001\nhead 0 0 1.6 0\n");
  NERITIC_ASSERT_OK(physics_, LivePhysics::create(scene_, LivePhysics::Pace::kClock));
  with(*physics_);
  end_after(0.5);
  const TimeNs begun_ns = now_ns();
  NERITIC_ASSERT_STATUS(dive(scene_, 0));
  EXPECT_GE(physics_->newest().time_s, 0.5 - 1e-9);
  EXPECT_LT(now_ns() - begun_ns, 60'000'000'000);
}

// In lock-step with the pictures, as a replay runs.
TEST_F(HeadsetWearer, SoDoesOneInLockStepWithItsPictures) {
  fakes::FakeHeadset fake("size 16 16\nperiod 0.00001\nhead 0 0 1.6 0\n");
  end_after(0.5);
  const TimeNs begun_ns = now_ns();
  NERITIC_ASSERT_STATUS(dive(scene_, 0));
  EXPECT_GE(physics_->newest().time_s, 0.5 - 1e-9);
  EXPECT_LT(now_ns() - begun_ns, 60'000'000'000);
}

// A wearer who holds still neither rows nor brakes the diver who swims on by plan, however seldom
// frames come.
TEST_F(HeadsetWearer, WhatIsTrackedRidesWithTheBodyThatSwimsOn) {
  fakes::FakeHeadset fake(
      "size 16 16\nperiod 0.1\nhead 0 0 1.6 0\nhand left 0 -0.15 1.35 -0.35\n"
      "hand right 0 0.2 1.3 -0.35\n");
  scene_ = dive_of(kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne +
                                            "swim = { waypoints_m = [[0, -12, -50]], "
                                            "speed_m_s = 0.5 }\n"))
               .scene;
  scene_.cameras.push_back(camera_for(scene_));
  NERITIC_ASSERT_OK(physics_, LivePhysics::create(scene_, LivePhysics::Pace::kPicture));
  with(*physics_);
  double fastest_m_s = 0.0;
  physics_->observe([&](const sim::Snapshot<PhysicsState>& now) {
    const auto& root = now.state.humans()[0].human.root;
    if (now.time_s > 2.0) fastest_m_s = std::max(fastest_m_s, glm::length(root.velocity.linear()));
  });
  NERITIC_ASSERT_STATUS(dive(scene_, 60));
  EXPECT_EQ(state().groups[static_cast<std::size_t>(DiverGroup::kHands)].phase, GroupPhase::kLive);
  EXPECT_GT(fastest_m_s, 0.1);
  EXPECT_LT(fastest_m_s, 0.8);
}

TEST_F(HeadsetWearer, APushedStickSwimsWhereTheHeadLooks) {
  fakes::FakeHeadset fake(
      "size 40 40\nhead 0 0 1.6 0\nprofile both oculus/touch_controller\n"
      "period 0.05\ninput /user/hand/left/input/thumbstick/y 0 1\n"
      "input /user/hand/left/input/thumbstick 0 0 1\n");
  const Vec3 start = state().human.root.position_ned_m;
  NERITIC_ASSERT_STATUS(dive(scene_, 120));
  EXPECT_EQ(state().groups[static_cast<std::size_t>(DiverGroup::kBody)].phase, GroupPhase::kLive);
  const Vec3 moved = world_from_ned(state().human.root.position_ned_m - start);
  const Vec3 ahead =
      drawn_pose(state()).rotation * inputs().head.world_from_head.rotation * Vec3(0, 0, -1);
  EXPECT_GT(glm::dot(moved, ahead), 0.6) << moved.x << " " << moved.y << " " << moved.z << " ahead "
                                         << ahead.x << " " << ahead.y << " " << ahead.z;
}

// A head in its tracked place bent the spine by which a swimmer steers: he sank by 24 m a minute.
TEST_F(HeadsetWearer, WhoSwimsWithALevelHeadKeepsHisDepth) {
  fakes::FakeHeadset fake(
      "size 16 16\nperiod 0.05\nhead 0 0 1.6 0\nprofile both oculus/touch_controller\n"
      "input /user/hand/left/input/thumbstick/y 0 1\n");
  const Vec3 start = state().human.root.position_ned_m;
  NERITIC_ASSERT_STATUS(dive(scene_, 400));
  const Vec3 moved = state().human.root.position_ned_m - start;
  EXPECT_GT(glm::length(Vec3(moved.x, moved.y, 0.0)), 5.0);
  EXPECT_LT(std::abs(moved.z), 1.0);
  EXPECT_FALSE(inputs().head.placed & kHeadPlaced);
}

// They rolled him by 73 degrees as they appeared.
TEST_F(HeadsetWearer, HandsThatAppearDoNotThrowTheBodyAbout) {
  fakes::FakeHeadset fake(
      "size 16 16\nperiod 0.05\nhead 0 0 1.6 0\nhands_seen no\nhand left 0 -0.2 1.3 -0.3\n"
      "hand right 0 0.6 1.5 0.1\nframe 40 hands_seen yes\n");
  double rolled_rad = 0.0, fastest_rad_s = 0.0;
  physics_->observe([&](const sim::Snapshot<PhysicsState>& now) {
    const auto& root = now.state.humans()[0].human.root;
    if (now.time_s < 1.9) return;
    const Vec3 starboard = root.attitude * Vec3(0, 1, 0);
    rolled_rad = std::max(rolled_rad, std::abs(std::asin(std::clamp(starboard.z, -1.0, 1.0))));
    fastest_rad_s = std::max(fastest_rad_s, glm::length(root.velocity.angular()));
  });
  NERITIC_ASSERT_STATUS(dive(scene_, 120));
  EXPECT_EQ(inputs().hand_poses.tracked, 3u | kHandsRide);
  EXPECT_LT(degrees(rolled_rad), 20.0);
  EXPECT_LT(fastest_rad_s, 1.0);
}

double yaw_deg(const Pose& pose) {
  const Vec3 ahead = pose.rotation * Vec3(0, 0, -1);
  return degrees(std::atan2(-ahead.x, -ahead.z));
}
double apart_deg(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 360.0));
}

// North for 16 m, then east: strokes sway the body by some 10 degrees, the turn is one of 90.
TEST(WearerStage, DoesNotSwayWithStrokesAndComesSlowlyWithATurn) {
  const scene::Scene scene =
      dive_of(kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne +
                                       "swim = { waypoints_m = [[0, -12, -16], [20, -12, -16]], "
                                       "speed_m_s = 0.45 }\n"))
          .scene;
  NERITIC_ASSERT_OK(const auto physics, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
  Wearer wearer(*physics);
  constexpr double kFrame_s = 0.02;
  double last_deg = 0.0, fastest_deg_s = 0.0, swayed_deg = 0.0, course_deg = 0.0, sway_deg = 0.0;
  for (double time_s = 0.0; time_s < 75.0; time_s += kFrame_s) {
    physics->reach(time_s);
    const double stage_deg = yaw_deg(wearer.world_from_stage({scene, &physics->motion()}, time_s));
    course_deg = degrees(course_of(drawn_pose(physics->shown().humans()[0]).rotation));
    if (time_s > 0.0)
      fastest_deg_s = std::max(fastest_deg_s, apart_deg(stage_deg, last_deg) / kFrame_s);
    last_deg = stage_deg;
    if (time_s > 30.0) continue;
    swayed_deg = std::max(swayed_deg, apart_deg(stage_deg, 0.0));
    sway_deg = std::max(sway_deg, apart_deg(course_deg, 0.0));
  }
  EXPECT_GT(sway_deg, 3.0);
  EXPECT_LT(swayed_deg, 0.1);
  EXPECT_LT(fastest_deg_s, 15.5);
  EXPECT_LT(apart_deg(course_deg, -90.0), 30.0);
  EXPECT_LT(apart_deg(last_deg, course_deg), 35.0);
}

TEST(WearerStage, TurnsByTheStickAndTheBodyComesRound) {
  const scene::Scene scene = dive_of(hover_text("")).scene;
  NERITIC_ASSERT_OK(const auto physics, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
  Wearer wearer(*physics);
  physics->listen({&wearer});
  constexpr double kFrame_s = 0.05;
  double begun_deg = 0.0, turned_deg = 0.0, course_deg = 0.0;
  for (int frame = 0; frame < 900; ++frame) {
    const double time_s = frame * kFrame_s;
    physics->reach(time_s);
    xr::DisplayFrame seen;
    seen.world_from_head = wearer.world_from_stage({scene, &physics->motion()}, time_s);
    if (frame == 20) begun_deg = yaw_deg(*seen.world_from_head);
    turned_deg = yaw_deg(*seen.world_from_head);
    course_deg = degrees(course_of(drawn_pose(physics->shown().humans()[0]).rotation));
    DiveInput input;
    if (frame >= 20 && frame < 50) input.look_rate.x = 1.0;  // 1.5 s to starboard
    wearer.take(seen, input, {}, 1.0, kFrame_s);
  }
  EXPECT_LT(apart_deg(turned_deg, begun_deg - 90.0), 3.1);
  EXPECT_LT(apart_deg(course_deg, turned_deg), 80.0);
  // Ahead again is where the body is.
  wearer.face_ahead();
  EXPECT_LT(
      apart_deg(yaw_deg(wearer.world_from_stage({scene, &physics->motion()}, 45.0)), course_deg),
      5.0);
}

// From arms that hang: the left hand before the chest, turned in, and the right one farther out. On
// a straight way the wrists went past the shoulders, where an arm turned by 167 degrees in a step.
// They go in front of the chest, not behind the back.
TEST(WearerHands, ThatComeIntoViewBringTheArmsThereAtASwimmersPace) {
  const scene::Scene scene = dive_of(hover_text("")).scene;
  for (const double frame_s : {1.0 / 72.0, 0.05}) {
    NERITIC_ASSERT_OK(const auto physics, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
    Wearer wearer(*physics);
    physics->listen({&wearer});
    std::optional<diver::JointRotations> last;
    double widest_rad = 0.0, behind_m = 0.0, dt_s = physics->world().step_s();
    physics->observe([&](const sim::Snapshot<PhysicsState>& now) {
      const diver::JointRotations& joints = now.state.humans()[0].human.held.joints;
      for (std::size_t i = 0; last && i < joints.size(); ++i) {
        const Quat off = glm::conjugate((*last)[i]) * joints[i];
        widest_rad = std::max(widest_rad,
                              2.0 * std::atan2(std::hypot(off.x, off.y, off.z), std::abs(off.w)));
      }
      last = joints;
      const diver::Posture posture =
          diver::posture_of(physics->world().humans()[0].body, joints, {});
      for (const diver::Segment hand : {diver::kLeftHand, diver::kRightHand})
        behind_m = std::min(behind_m, posture[hand].origin_m.z);
    });
    for (double time_s = 0.0; time_s < 3.0; time_s += frame_s) {
      physics->reach(time_s);
      xr::DisplayFrame seen;
      const Pose stage = wearer.world_from_stage({scene, &physics->motion()}, time_s);
      seen.world_from_head = stage;
      // The backs of the hands up, fingers ahead.
      const Quat palms_in = from_yaw_pitch_roll(0.0, radians(90.0), 0.0);
      const Quat left = from_yaw_pitch_roll(radians(-70.0), 0.0, 0.0) * palms_in;
      seen.tracked.hands = {stage * Pose{Vec3(-0.1, -0.24, -0.34), left},
                            stage * Pose{Vec3(0.3, -0.4, -0.3), palms_in}};
      wearer.take(seen, {}, {}, 1.0, frame_s);
    }
    // An elbow gets straight like the root of what is left to go.
    EXPECT_LT(degrees(widest_rad), 30.0) << frame_s;
    EXPECT_GT(behind_m, -0.08) << frame_s;
    EXPECT_GT(widest_rad, 0.5 * kFastestEase_rad_s * dt_s) << frame_s;
    const HumanPhysics& diver = physics->newest().state.humans()[0];
    EXPECT_EQ(diver.ease.left_s, 0.0) << frame_s;
    EXPECT_EQ(diver.groups[static_cast<std::size_t>(DiverGroup::kHands)].jumps, 0u) << frame_s;
  }
}

// From a metre before the own eyes, looking back: the crown would be nearer than that.
TEST_F(HeadsetWearer, TheOwnBodyIsSeenWithoutItsHead) {
  const std::string back = fmt::format(
      "size 120 120\nviews 1\nfov -40 40 40 -40\nhead 0 0 1.6 -1 180\nout {}\nout_frames 2\n",
      folder());
  // Within 0.15 m around the line of sight that ends in the own eyes.
  const auto nearest_m = [&] {
    const auto depth = read_npy(folder() + "/frame_0002_view_0_depth.npy").value();
    const std::vector<double> metres = depth.to_doubles();
    double nearest = 1e9;
    for (std::size_t y = 52; y < 68; ++y)
      for (std::size_t x = 52; x < 68; ++x) nearest = std::min(nearest, metres[y * 120 + x]);
    return nearest;
  };
  fakes::FakeHeadset fake(back);
  NERITIC_ASSERT_STATUS(dive(scene_, 4));
  const double worn_m = nearest_m();
  EXPECT_GT(worn_m, 1.0);
  EXPECT_LT(worn_m, 3.0);  // the shoulders
}

}  // namespace
}  // namespace neritic::testbed
