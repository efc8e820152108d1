// Objects that devices move: what holds when the device stops, what is refused, and a run of them
// recorded, repeated, played and restored.
#include "testbed/record/source_watch.hpp"
#include "testbed/simulation/saved_state.hpp"
#include "tests/testbed/simulation/capture.hpp"
#include "tests/testbed/simulation/replay_run.hpp"

namespace neritic::testbed {
namespace {

TEST(ObjectPose, BeforeAnySampleItIsWhereTheSceneHasItAndSilentItStays) {
  TestDive dive = dive_of(prop_text("inputs = { pose = \"mocap\" }\n"));
  std::vector<std::string> told;
  SourceWatch watch(*dive.world, dive.simulation->inbox(),
                    [&](const std::string& line) { told.push_back(line); });
  Capture capture(dive);
  const auto step = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      dive.simulation->advance(1);
      ASSERT_TRUE(watch.accept(dive.simulation->newest(), {}).ok());
    }
  };
  step(10);
  EXPECT_EQ(prop(dive).placed, 0u);
  capture.see(0.00, at({1, -5, 0})), step(2);
  capture.see(0.01, at({1.02, -5, 0})), step(24);
  const double stopped_m = prop(dive).motion.pose.position_m.x;
  EXPECT_NEAR(stopped_m, 1.02 + 2.0 * 0.1, 1e-9);  // 2 m/s for 0.1 s
  step(400);
  EXPECT_EQ(prop(dive).groups[0].phase, GroupPhase::kLost);
  EXPECT_NEAR(prop(dive).motion.pose.position_m.x, stopped_m, 1e-12);
  EXPECT_EQ(prop(dive).motion.velocity_m_s, Vec3(0.0));
  capture.see(2.0, at({3, -5, 0})), step(1);
  EXPECT_EQ(prop(dive).motion.pose.position_m.x, 3.0);
  EXPECT_EQ(prop(dive).motion.velocity_m_s, Vec3(0.0));
  ASSERT_EQ(told.size(), 3u);
  EXPECT_TRUE(told[0].ends_with("prop: pose: live from mocap"));
  EXPECT_TRUE(told[1].ends_with("prop: pose: mocap is silent, nobody acts"));
  EXPECT_TRUE(told[2].ends_with("prop: pose: mocap is heard again"));
}

TEST(ObjectPose, WrongPosesAreRefusedAndCountedBySourceAndMoveNothing) {
  TestDive dive = dive_of(prop_text("inputs = { pose = \"mocap\" }\n"));
  Capture capture(dive);
  using enum SampleVerdict;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(capture.see(1.0, at({1, -5, 0})), kAccepted);
  EXPECT_EQ(capture.see(1.0, at({nan, -5, 0})), kNotFinite);
  EXPECT_EQ(capture.see(1.0, at({1e12, -5, 0})), kNotPlausible);
  EXPECT_EQ(capture.see(1.0, at({1, -5, 0}, Quat(0, 0, 0, 0))), kNotPlausible);
  EXPECT_EQ(capture.see(1.0, at({1, -5, 0}, Quat(1.01, 0, 0, 0))), kNotPlausible);
  EXPECT_EQ(capture.see(1.0, at({1, -5, 0}, Quat(1e200, 0, 0, 0))), kNotPlausible);
  EXPECT_EQ(capture.see(1.0, at({1, -5, 0}, Quat(0.70710678f, 0.70710678f, 0, 0))), kAccepted);
  ObjectPose fast = at({1, -5, 0});
  fast.velocity_m_s.x = -1e5;
  EXPECT_EQ(capture.see(1.0, fast), kAccepted);  // it does not count
  fast.measured = 1;
  EXPECT_EQ(capture.see(1.0, fast), kNotPlausible);
  EXPECT_EQ(capture.see(1.0, at({2, -5, 0}), 0.6), kLate);
  capture.sequence = 4;
  EXPECT_EQ(capture.see(1.0, at({2, -5, 0})), kRepeated);
  capture.sequence = 20;
  EXPECT_EQ(capture.see(0.5, at({2, -5, 0})), kOutOfOrder);
  const SourceCounts counts = dive.simulation->inbox().counts(capture.source);
  EXPECT_EQ(counts.not_finite, 1u);
  EXPECT_EQ(counts.not_plausible, 5u);
  EXPECT_EQ(counts.late + counts.repeated + counts.out_of_order, 3u);
  EXPECT_EQ(counts.accepted, 3u);
  dive.simulation->advance(1);
  EXPECT_EQ(prop(dive).motion.pose.position_m, Vec3(1, -5, 0));
}

TEST(ObjectPose, ABurstCostsOldPosesNeverTheNewest) {
  TestDive dive = dive_of(prop_text("inputs = { pose = \"mocap\" }\n"));
  Capture capture(dive);
  constexpr int kBurst = 100'000;
  for (int i = 1; i <= kBurst; ++i) capture.see(1e-6 * i, at({1e-5 * i, -5, 0}));
  dive.simulation->advance(1);
  const SourceCounts counts = dive.simulation->inbox().counts(capture.source);
  EXPECT_EQ(counts.accepted, std::uint64_t{kBurst});
  EXPECT_EQ(counts.dropped + prop(dive).groups[0].heard, std::uint64_t{kBurst});
  EXPECT_NEAR(prop(dive).motion.velocity_m_s.x, 10.0, 1e-6);
  EXPECT_NEAR(prop(dive).motion.pose.position_m.x, 1.0 + 10.0 / 240.0, 1e-6);
}

// A vehicle follows the prop, and a camera's carrier rides on it.
std::string followed_text() {
  return prop_text("inputs = { pose = \"mocap\" }\n") +
         rov_text(
             "position_m = [3, -5, 3]\nmission = { look_at = \"prop\", follow = { object = "
             "\"prop\", offset_m = [0, 0, 2] } }\n");
}

SampleLog circled(TestDive& dive, int steps) {
  Capture capture(dive);
  for (int i = 0; i < steps; ++i) {
    const Motion at_i = circling(i / 240.0);
    if (i % 3 == 0) capture.see(i / 240.0, at(at_i.pose.position_m, at_i.pose.rotation));
    dive.simulation->advance(1);
  }
  return recorded_run(*dive.world, *dive.simulation);
}

TEST(ObjectPose, ARunIsRepeatedBitForBitAndAMissionFollowsTheProp) {
  TestDive dive = dive_of(followed_text());
  const SampleLog log = circled(dive, 2400);
  const auto report = replay_run(*dive.world, log, "run.mcap").value();
  EXPECT_EQ(report.steps, 2400u);
  EXPECT_FALSE(report.first_difference.has_value());
  EXPECT_GT(dive.speed_m_s(), 0.2);
  // Its setpoint of the last control period lies 2 m behind the prop.
  EXPECT_NEAR(glm::distance(rov::world_from_ned(dive.vehicle().mission.wanted_ned_m),
                            prop(dive).motion.pose.position_m),
              2.0, 0.1);
  // The bytes of the log say the same.
  const std::string bytes = encode_sample_log(log);
  const auto read = parse_sample_log(std::as_bytes(std::span(bytes)), "run.mcap");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_FALSE(replay_run(*dive.world, *read, "run.mcap")->first_difference.has_value());
}

TEST(ObjectPose, ARecordingMovesThePropOfAnotherRun) {
  TestDive first = dive_of(followed_text());
  SampleLog log = circled(first, 240);
  TestDive dive = dive_of(prop_text("inputs = { pose = \"mocap\" }\n"));
  auto recording =
      RecordedSource::create(std::move(log), dive.world->streams(), "prop.mcap").value();
  for (int i = 0; i < 240; ++i) {
    ASSERT_TRUE(recording.poll(dive.simulation->inbox(), dive.time_s()).ok());
    dive.simulation->advance(1);
  }
  EXPECT_EQ(prop(dive).motion.pose.position_m, prop(first).motion.pose.position_m);
  EXPECT_EQ(prop(dive).motion.velocity_m_s, prop(first).motion.velocity_m_s);
}

TEST(ObjectPose, ASavedRunGoesOnWithTheSameHashes) {
  TestDive whole = dive_of(followed_text()), half = dive_of(followed_text());
  const SampleLog log = circled(whole, 480);
  const StateFormat format = half.world->state_format();
  circled(half, 240);
  const auto bytes = encode_state(format, saved_state(*half.simulation, format));
  const auto saved = parse_state(format, bytes, "half.state");
  ASSERT_TRUE(saved.ok()) << saved.error().message;
  TestDive rest = dive_of(followed_text());
  restore_state(*rest.simulation, *saved);
  Capture capture(rest);
  capture.sequence = 80;
  for (int i = 240; i < 480; ++i) {
    const Motion at_i = circling(i / 240.0);
    if (i % 3 == 0) capture.see(i / 240.0, at(at_i.pose.position_m, at_i.pose.rotation));
    rest.simulation->advance(1);
    ASSERT_EQ(rest.simulation->newest().hash, log.hashes[static_cast<std::size_t>(i) + 1]) << i;
  }
}

TEST(ObjectPose, ItIsNotSolidAndScenesThatMeanOtherwiseAreRefused) {
  const auto world =
      PhysicsWorld::create(load_text(prop_text("inputs = { pose = \"a\" }\n")).value());
  EXPECT_EQ(world.value()->solid().counts().things, 0u);
  EXPECT_EQ(
      PhysicsWorld::create(load_text(prop_text("") + rov_text("position_m = [5, -5, 5]\n")).value())
          .value()
          ->solid()
          .counts()
          .things,
      1u);
  const auto refused = [](const std::string& keys, const std::string& what) {
    const auto scene = load_text(prop_text(keys));
    ASSERT_FALSE(scene.ok()) << keys;
    EXPECT_NE(scene.error().message.find(what), std::string::npos) << scene.error().message;
  };
  refused("inputs = { pose = \"a\" }\ncollision = true\n", "a clip, inputs or thing is not solid");
  refused("inputs = { wrench = \"a\" }\n", "wrench");
  refused("inputs = { pose = \"recording\" }\n", "recording");
  refused("inputs = {}\n", "a table with the key pose");
  refused("inputs = { pose = { from = \"a\", hold_s = -1 } }\n", "hold_s");
  const auto still =
      load_text("[[objects]]\nname = \"prop\"\nshape = \"box\"\ninputs = { pose = \"a\" }\n");
  ASSERT_FALSE(still.ok());
  EXPECT_NE(still.error().message.find("without [physics]"), std::string::npos);
}

}  // namespace
}  // namespace neritic::testbed
