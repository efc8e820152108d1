// A diver swum by keys in a window: where the keys say, up, down and round, and given back.
#include <gtest/gtest.h>

#include "diver/frames.hpp"
#include "diver/jacket.hpp"
#include "testbed/simulation/human_readings.hpp"
#include "testbed/view/dive_camera.hpp"
#include "testbed/view/wearer.hpp"
#include "tests/testbed/simulation/devices.hpp"

namespace neritic::testbed {
namespace {

class DiverKeys : public testing::Test {
 protected:
  void SetUp() override {
    scene_ =
        dive_of(kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne)).scene;
    physics_ = LivePhysics::create(scene_, LivePhysics::Pace::kPicture).value();
    physics_->start();
    wearer_.emplace(*physics_);
  }
  void hold(const DiveInput& input, double seconds, const std::optional<Quat>& eyes = {},
            double frame_s = 0.05) {
    for (const double end_s = time_s_ + seconds; time_s_ < end_s; time_s_ += frame_s) {
      wearer_->take({}, input, eyes);
      ASSERT_TRUE(wearer_->poll(physics_->inbox(), time_s_).ok());
      physics_->follow(0, time_s_);
    }
  }
  const HumanPhysics& state() const { return physics_->shown().humans()[0]; }
  Vec3 place() const { return diver::world_from_ned(state().human.root.position_ned_m); }
  GroupPhase phase(DiverGroup group) const {
    return state().groups[static_cast<std::size_t>(group)].phase;
  }
  Vec3 ahead() const {
    return from_yaw_pitch_roll(course_of(drawn_pose(state()).rotation), 0.0, 0.0) * Vec3(0, 0, -1);
  }

  scene::Scene scene_;
  std::unique_ptr<LivePhysics> physics_;
  std::optional<Wearer> wearer_;
  double time_s_ = 0.0;
};

TEST_F(DiverKeys, AheadRoundDownAndStay) {
  hold({}, 1.0);
  EXPECT_NE(phase(DiverGroup::kBody), GroupPhase::kLive);
  wearer_->swim_by_keys(true);
  Vec3 start = place(), before = ahead();
  hold({.move = {0, 0, -1}}, 8.0);  // W
  EXPECT_EQ(phase(DiverGroup::kBody), GroupPhase::kLive);
  EXPECT_GT(glm::dot(place() - start, before), 1.5);
  hold({.move = {1, 0, -1}}, 6.0);  // W and D: to starboard
  EXPECT_GT(glm::dot(glm::cross(before, ahead()), Vec3(0, -1, 0)), 0.4);
  start = place();
  hold({.move = {0, -1, -1}}, 25.0);  // W and Q
  EXPECT_LT(place().y, start.y - 0.5);
  hold({}, 6.0);
  start = place();
  hold({}, 6.0);
  EXPECT_LT(glm::distance(start, place()), 1.2);
}

// Fast, as nobody is taught to rise, and slower than that with what a frame takes of the limbs.
TEST_F(DiverKeys, GoesUpAndDownAsFastAsAskedAndRestsWhereTheKeyIsLetGo) {
  wearer_->swim_by_keys(true);
  hold({}, 5.0);
  for (const auto& [up, fast, rate_m_s] :
       {std::tuple(-1.0, false, 0.15), std::tuple(1.0, false, 0.15),
        std::tuple(-1.0, true, 0.25)}) {
    hold({.move = {0, up, 0}, .fast = fast}, 4.0);
    const double from_m = place().y;
    hold({.move = {0, up, 0}, .fast = fast}, 6.0);
    EXPECT_NEAR(up * (place().y - from_m), 6.0 * rate_m_s, 2.0 * rate_m_s) << up << fast;
    EXPECT_EQ(phase(DiverGroup::kBreath), GroupPhase::kLive);
    EXPECT_NE(state().human.held.breath_bias_m3, 0.0);
    EXPECT_EQ(human_reading(physics_->world().humans()[0], state(), {}).breath_quality,
              ValueQuality::kModelled);
    const double let_go_m = place().y;
    hold({}, 3.0);
    const double rests_m = place().y;
    EXPECT_LT(std::abs(rests_m - let_go_m), 3.0 * rate_m_s) << up << fast;
    for (int second = 0; second < 20; ++second) {
      hold({}, 1.0);
      EXPECT_NEAR(place().y, rests_m, 0.4) << up << fast;
    }
  }
}

TEST_F(DiverKeys, KeepsTheDepthAheadAfterItWasReached) {
  wearer_->swim_by_keys(true);
  hold({.move = {0, -1, -1}}, 8.0);  // W and Q
  hold({.move = {0, 0, -1}}, 4.0);
  const double depth_m = place().y;
  for (int second = 0; second < 30; ++second) {
    hold({.move = {0, 0, -1}}, 1.0);
    EXPECT_NEAR(place().y, depth_m, 0.6);
  }
}

TEST_F(DiverKeys, StaysAtTheSurfaceWhileHeAsksToRiseAndLeavesItWhenAsked) {
  wearer_->swim_by_keys(true);
  hold({.move = {0, 1, 0}, .fast = true}, 70.0);
  const double top_m = place().y;
  EXPECT_GT(top_m, -0.8);
  hold({.move = {0, 1, 0}}, 10.0);
  EXPECT_NEAR(place().y, top_m, 0.4);
  EXPECT_LT(glm::length(state().human.root.velocity.angular()), 1.5);
  hold({.move = {0, -1, 0}}, 20.0);
  EXPECT_LT(place().y, top_m - 0.8);
}

TEST_F(DiverKeys, TheJacketsKeysGoBeforeTheSwimmersOwn) {
  wearer_->swim_by_keys(true);
  hold({.jacket = diver::kInflate}, 1.0);
  EXPECT_EQ(state().human.held.buttons, diver::kInflate);
}

TEST_F(DiverKeys, LettingGoGivesTheDiverBack) {
  wearer_->swim_by_keys(true);
  hold({.move = {0, 0, -1}}, 2.0);
  wearer_->swim_by_keys(false);
  hold({}, 1.0);
  EXPECT_NE(phase(DiverGroup::kBody), GroupPhase::kLive);
  EXPECT_NE(phase(DiverGroup::kButtons), GroupPhase::kLive);
  EXPECT_NE(phase(DiverGroup::kBody), GroupPhase::kLost);
  wearer_->swim_by_keys(true);
  hold({.move = {0, 0, -1}}, 1.0);
  EXPECT_EQ(phase(DiverGroup::kBody), GroupPhase::kLive);
}

// The swimmer's face points down, the view does not.
TEST_F(DiverKeys, TheGazeIsWhereTheMiddleOfTheOwnViewPoints) {
  hold({}, 1.0);
  const auto gaze = [&] { return diver::world_from_ned(state().human.life.vitals.gaze_ned); };
  EXPECT_LT(gaze().y, -0.5);
  EXPECT_EQ(state().human.life.vitals.measured & diver::kGazeMeasured, 0u);
  wearer_->swim_by_keys(true);
  for (const double yaw : {0.4, -1.9}) {
    const Quat eyes = from_yaw_pitch_roll(yaw, 0.1, 0.0);
    hold({}, 0.5, eyes);
    EXPECT_NE(state().human.life.vitals.measured & diver::kGazeMeasured, 0u);
    EXPECT_LT(glm::distance(gaze(), eyes * Vec3(0, 0, -1)), 1e-6) << yaw;
  }
  EXPECT_EQ(phase(DiverGroup::kGaze), GroupPhase::kLive);
  hold({}, 0.5);  // another view
  EXPECT_EQ(phase(DiverGroup::kGaze), GroupPhase::kChosen);
  hold({}, 0.5, Quat(1, 0, 0, 0));
  EXPECT_EQ(phase(DiverGroup::kGaze), GroupPhase::kLive);
  wearer_->swim_by_keys(false);
  hold({}, 0.5);
  EXPECT_EQ(phase(DiverGroup::kGaze), GroupPhase::kChosen);
}

TEST_F(DiverKeys, InTheOwnViewTurningMovesNobodyAndAheadIsWhereTheViewPoints) {
  wearer_->swim_by_keys(true);
  const Vec3 start = place();
  const Quat eyes = from_yaw_pitch_roll(radians(-70.0), radians(20.0), 0.0);
  hold({.move = {1, 0, 0}, .turn = 1.0}, 8.0, eyes);
  EXPECT_LT(glm::distance(start, place()), 0.5);
  hold({.move = {0, 0, -1}}, 25.0, eyes);
  const Vec3 swum = place() - start;
  EXPECT_GT(glm::dot(swum, from_yaw_pitch_roll(radians(-70.0), 0.0, 0.0) * Vec3(0, 0, -1)), 4.0);
  EXPECT_LT(std::abs(swum.y), 1.5);
}

TEST_F(DiverKeys, WithoutAKeyHeHoversByHimselfHoweverSeldomFramesCome) {
  wearer_->swim_by_keys(true);
  const Vec3 start = place();
  hold({}, 200.0, Quat(1, 0, 0, 0), 0.27);
  EXPECT_NEAR(place().y, start.y, 0.5);
  EXPECT_EQ(phase(DiverGroup::kBody), GroupPhase::kChosen);
}

// Ten seconds of the scene in one of the host, in which a few frames come.
TEST_F(DiverKeys, InFastTimeTheKeysAreNotSilentBetweenTwoFrames) {
  wearer_->swim_by_keys(true);
  for (int frame = 0; frame < 6; ++frame) {
    wearer_->take({}, {.move = {0, 0, -1}}, {}, 10.0);
    ASSERT_TRUE(wearer_->poll(physics_->inbox(), time_s_).ok());
    physics_->follow(0, time_s_ += 2.5);
    if (frame == 0) continue;  // limbs follow the claim with the next frame
    EXPECT_EQ(phase(DiverGroup::kBody), GroupPhase::kLive) << frame;
  }
  EXPECT_EQ(state().groups[static_cast<std::size_t>(DiverGroup::kBody)].losses, 0u);
}

}  // namespace
}  // namespace neritic::testbed
