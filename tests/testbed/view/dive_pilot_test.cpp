// A vehicle flown by keys in the live program: it takes over, goes where the keys say, and gives
// back.
#include "testbed/view/dive_pilot.hpp"

#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

class DivePilotTest : public testing::Test {
 protected:
  void SetUp() override {
    const test::ScratchFolder scratch;
    const std::string dynamics =
        (test::source_dir() / "assets/vehicles/bluerov2_heavy_dynamics.toml").string();
    ASSERT_TRUE(write_text(scratch / "s.toml", R"([physics]
[[vehicles]]
name = "rov"
shape = "box"
dynamics = ")" + dynamics + R"("
position_m = [0, -6, 0]
mission = { hold = "station" }
)")
                    .ok());
    scene_ = scene::load_scene(scratch / "s.toml").value();
    physics_ = LivePhysics::create(scene_, LivePhysics::Pace::kPicture).value();
    physics_->start();
  }
  void fly(DivePilot& pilot, DiveInput input, double seconds, bool expected = true) {
    for (const double end_s = time_s_ + seconds; time_s_ < end_s; time_s_ += 0.05) {
      EXPECT_EQ(pilot.take(input, -1), expected);
      input.toggle_pilot = false;
      ASSERT_TRUE(pilot.poll(physics_->inbox(), time_s_).ok());
      physics_->follow(0, time_s_);
    }
  }

  std::string doing(const DivePilot& pilot) const {
    return pilot.doing(physics_->world().vehicles()[0].object);
  }

  scene::Scene scene_;
  std::unique_ptr<LivePhysics> physics_;
  double time_s_ = 0.0;
};

TEST_F(DivePilotTest, KeysMoveItAheadAsideUpAndRound) {
  DivePilot pilot = DivePilot::create(physics_.get()).value();
  DiveInput input;
  fly(pilot, input, 1.0, false);
  EXPECT_LT(glm::distance(physics_->pose(0).position_m, Vec3(0, -6, 0)), 0.02);
  input.toggle_pilot = true;
  input.move = {0, 0, -1};  // W
  fly(pilot, input, 3.0);
  EXPECT_LT(physics_->pose(0).position_m.z, -0.7);
  input = {};
  input.move = {1, 1, 0};  // D and E
  const Vec3 before = physics_->pose(0).position_m;
  fly(pilot, input, 3.0);
  EXPECT_GT(physics_->pose(0).position_m.x - before.x, 0.5);
  EXPECT_GT(physics_->pose(0).position_m.y - before.y, 0.5);
  input = {};
  input.turn = 1.0;  // Right
  fly(pilot, input, 1.0);
  const Vec3 ahead = physics_->pose(0).rotation * Vec3(0, 0, -1);
  EXPECT_GT(ahead.x, 0.2);
}

TEST_F(DivePilotTest, AtFullThrustItStaysUpright) {
  DivePilot pilot = DivePilot::create(physics_.get()).value();
  DiveInput input;
  input.toggle_pilot = input.fast = true;
  input.move = {0, 0, -1};
  fly(pilot, input, 10.0);
  EXPECT_LT(physics_->pose(0).position_m.z, -4.0);
  EXPECT_GT((physics_->pose(0).rotation * Vec3(0, 1, 0)).y, 0.9);
}

TEST_F(DivePilotTest, TheMissionComesBack) {
  DivePilot pilot = DivePilot::create(physics_.get()).value();
  DiveInput input;
  input.toggle_pilot = true;
  input.move = {0, 0, -1};
  fly(pilot, input, 2.0);
  EXPECT_NE(doing(pilot).find("piloted"), std::string::npos) << doing(pilot);
  input = {};
  input.toggle_pilot = true;
  fly(pilot, input, 8.0, false);
  EXPECT_EQ(doing(pilot).find("piloted"), std::string::npos) << doing(pilot);
  EXPECT_LT(glm::length(physics_->shown().vehicles()[0].body.velocity.linear()), 0.02);
}

// A window that draws no more sends no keys; another device sends wrenches that nobody asked for.
TEST_F(DivePilotTest, TheLinesNameTheSourceThatHasTheAuthorityNow) {
  DivePilot pilot = DivePilot::create(physics_.get()).value();
  const SourceId other = physics_->inbox().open("joystick").value();
  const StreamId wrench = physics_->world().streams().find("rov/wrench").value();
  physics_->inbox().push({{wrench, other, 0, 0, 0}, VehicleWrench{}});
  physics_->follow(0, time_s_ += 0.1);
  ASSERT_EQ(pilot.troubles().size(), 1u);
  EXPECT_EQ(pilot.troubles()[0], "rov: wrench: 1 sample of joystick not used, autopilot");
  DiveInput input;
  input.toggle_pilot = true;
  fly(pilot, input, 0.2);
  EXPECT_EQ(pilot.troubles()[0], "rov: wrench: 1 sample of joystick not used, live from keyboard");
  physics_->follow(0, time_s_ += 3.0);
  EXPECT_EQ(pilot.troubles()[0],
            "rov: wrench: keyboard is silent, autopilot acts; "
            "1 sample of joystick not used, live from keyboard");
}

// The keyboard's hold is a time of the host: ten seconds of the scene pass in it.
TEST_F(DivePilotTest, InFastTimeTheKeyboardIsNotSilentBetweenTwoFrames) {
  DivePilot pilot = DivePilot::create(physics_.get()).value();
  DiveInput input;
  input.toggle_pilot = true;
  for (int frame = 0; frame < 6; ++frame) {
    EXPECT_TRUE(pilot.take(input, -1, 10.0));
    input = {.move = {0, 0, -1}};
    ASSERT_TRUE(pilot.poll(physics_->inbox(), time_s_).ok());
    physics_->follow(0, time_s_ += 2.5);
    EXPECT_EQ(pilot.troubles(), std::vector<std::string>{}) << frame;
    EXPECT_NE(doing(pilot).find("piloted"), std::string::npos) << doing(pilot);
  }
  // At the usual pace it holds for a second again.
  EXPECT_TRUE(pilot.take(input, -1, 1.0));
  ASSERT_TRUE(pilot.poll(physics_->inbox(), time_s_).ok());
  physics_->follow(0, time_s_ += 2.5);
  EXPECT_EQ(pilot.troubles(),
            std::vector<std::string>{"rov: wrench: keyboard is silent, autopilot acts"});
  EXPECT_NE(doing(pilot).find("the keys are not heard"), std::string::npos) << doing(pilot);
}

TEST_F(DivePilotTest, WithoutPhysicsNothingIsFlown) {
  DivePilot pilot = DivePilot::create(nullptr).value();
  DiveInput input;
  input.toggle_pilot = true;
  EXPECT_FALSE(pilot.take(input, -1));
  EXPECT_TRUE(pilot.troubles().empty());
}

// P over a diver alone: there is no vehicle to ride on or to take over.
TEST_F(DivePilotTest, InASceneOfDiversAloneNothingIsFlown) {
  const scene::Scene divers =
      load_text(kStillWater + diver_text("position_m = [0, -12, 0]\n")).value();
  physics_ = LivePhysics::create(divers, LivePhysics::Pace::kPicture).value();
  physics_->start();
  DivePilot pilot = DivePilot::create(physics_.get()).value();
  DiveInput input;
  input.toggle_pilot = true;
  fly(pilot, input, 0.2, false);
  EXPECT_TRUE(pilot.troubles().empty());
}

TEST_F(DivePilotTest, InAReplayNothingIsFlown) {
  DivePilot pilot = DivePilot::create(physics_.get(), false).value();
  DiveInput input;
  input.toggle_pilot = true;
  input.move = {0, 0, -1};
  fly(pilot, input, 1.0, false);
  EXPECT_EQ(doing(pilot).find("piloted"), std::string::npos) << doing(pilot);
  EXPECT_GT(physics_->pose(0).position_m.z, -0.1);
}

TEST_F(DivePilotTest, WithoutRoomForTheKeyboardItIsAnError) {
  for (int i = 0; physics_->inbox().open(fmt::format("device_{}", i)).ok();) ++i;
  const auto pilot = DivePilot::create(physics_.get());
  ASSERT_FALSE(pilot.ok());
  EXPECT_EQ(pilot.error().message.rfind("source: keyboard: found ", 0), 0u)
      << pilot.error().message;
}

}  // namespace
}  // namespace neritic::testbed
