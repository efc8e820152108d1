// Live samples on a diver in a scene: real buttons on an autopilot's body, three sources at their
// own rates, a source that falls silent, a burst beside a thread that steps.
#include <thread>

#include "testbed/record/run_record.hpp"
#include "testbed/record/source_watch.hpp"
#include "tests/testbed/simulation/devices.hpp"
#include "tests/testbed/simulation/replay_run.hpp"

namespace neritic::testbed {
namespace {

double depth_m(const TestDive& dive) {
  return dive.state().humans()[0].human.root.position_ned_m.z;
}

TEST(LiveInputs, RealButtonsOnAnAutopilotsBodyChangeItsDepth) {
  TestDive hovers = dive_of(hover_text("body = \"autopilot\""));
  TestDive pressed = dive_of(hover_text("buttons = \"controllers\""));
  Device controllers(pressed, "controllers", "diver/buttons");
  hovers.run(8.0);
  pressed.run(8.0, [&] { controllers.say(JacketButtons{diver::kInflate}); });
  EXPECT_NEAR(depth_m(hovers), 12.0, 1.0);
  EXPECT_LT(depth_m(pressed), depth_m(hovers) - 2.0);
  EXPECT_EQ(group(pressed, DiverGroup::kButtons).phase, GroupPhase::kLive);
  EXPECT_EQ(group(pressed, DiverGroup::kBody).phase, GroupPhase::kChosen);
}

TEST(LiveInputs, ThreeSourcesAtTheirOwnRatesAndTheReplayOfThem) {
  TestDive dive =
      dive_of(hover_text("body = \"suit\", buttons = \"controllers\", heart = \"strap\""));
  Device suit(dive, "suit", "diver/joints"), controllers(dive, "controllers", "diver/buttons"),
      strap(dive, "strap", "diver/heart");
  BodyJoints body;
  for (std::uint64_t step = 0; step < 5 * 240; ++step) {
    body.joints[0] = glm::angleAxis(0.2 * std::sin(0.01 * double(step)), Vec3(0.0, 1.0, 0.0));
    suit.say(body);
    if (step % 24 == 0) controllers.say(JacketButtons{step / 24 % 2});
    Heart heart;
    heart.state.beats = step;
    if (step % 240 == 0) strap.say(heart);
    dive.simulation->advance(1);
    const DiverInputs& inputs = dive.simulation->inputs().humans()[0];
    ASSERT_EQ(inputs.body.joints[0].y, body.joints[0].y);
    ASSERT_EQ(inputs.buttons.pressed, step / 24 % 2);
    ASSERT_EQ(inputs.heart.state.beats, step / 240 * 240);
  }
  for (const DiverGroup each : {DiverGroup::kBody, DiverGroup::kButtons, DiverGroup::kHeart}) {
    EXPECT_EQ(group(dive, each).phase, GroupPhase::kLive);
    EXPECT_EQ(group(dive, each).losses, 0u);
  }
  const SampleLog log = recorded_run(*dive.world, *dive.simulation);
  EXPECT_EQ(log.entries.size(), 1200u + 50u + 5u);
  EXPECT_FALSE(replay_run(*dive.world, log, "run.mcap").value().first_difference.has_value());
}

TEST(LiveInputs, ASuitThatFallsSilentIsCountedAndTheAutopilotSwims) {
  TestDive dive = dive_of(hover_text("body = { from = \"suit\", hold_s = 0.25 }"));
  Device suit(dive, "suit", "diver/joints");
  EXPECT_EQ(group(dive, DiverGroup::kBody).phase, GroupPhase::kChosen);  // before the first step
  dive.run(0.1);
  EXPECT_EQ(group(dive, DiverGroup::kBody).phase, GroupPhase::kWaiting);
  suit.say(BodyJoints{});
  dive.run(0.2);
  EXPECT_EQ(group(dive, DiverGroup::kBody).phase, GroupPhase::kLive);
  dive.run(0.2);
  EXPECT_EQ(group(dive, DiverGroup::kBody).phase, GroupPhase::kLost);
  EXPECT_EQ(group(dive, DiverGroup::kBody).losses, 1u);
  dive.run(20.0);
  EXPECT_NEAR(depth_m(dive), 12.0, 2.0);
  suit.say(BodyJoints{});
  dive.run(0.01);
  EXPECT_EQ(group(dive, DiverGroup::kBody).phase, GroupPhase::kLive);
}

// Counts the diver's readings on the stepping thread.
class Counter final : public StepSink {
 public:
  explicit Counter(const PhysicsWorld& world)
      : stream_(world.streams().find("diver/motion").value()) {}
  std::vector<StreamId> streams() const override { return {stream_}; }
  Status accept(const sim::Snapshot<PhysicsState>&, std::span<const Sample> outputs) override {
    for (const Sample& sample : outputs) gaps += sample.header.sequence != readings++;
    return {};
  }
  Status finish() override { return {}; }
  std::uint64_t readings = 0, gaps = 0;

 private:
  StreamId stream_;
};

// Three threads send while the simulation's thread steps on a simulated clock and gives each step
// to its sinks, and a fourth bursts.
TEST(LiveInputs, ABurstBesideTheSteppingThreadIsCountedAndTheRunReplays) {
  const TestDive dive = dive_of(hover_text("body = \"suit\", buttons = \"controllers\""));
  auto reader = dive.simulation->reader();
  sim::SimulatedClock clock;
  Device suit(dive, "suit", "diver/joints"), controllers(dive, "controllers", "diver/buttons"),
      noise(dive, "noise", "diver/gas");
  std::vector<std::string> told;
  SourceWatch watch(*dive.world, dive.simulation->inbox(),
                    [&](const std::string& line) { told.push_back(line); });
  Counter counter(*dive.world);
  StepSinks sinks(*dive.world, {&watch, &counter});
  sinks.accept(dive.simulation->newest());
  dive.simulation->observe([&](const auto& step) { sinks.accept(step); });
  dive.simulation->start(clock);
  std::vector<std::jthread> threads;
  for (Device* device : {&suit, &controllers})
    threads.emplace_back([device](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        // Every second one is of the other device's kind.
        device->say(empty_payload(device->sequence % 2 == 0 ? PayloadKind::kBodyJoints
                                                            : PayloadKind::kButtons));
        std::this_thread::yield();
      }
    });
  threads.emplace_back([&noise] {
    for (int i = 0; i < 20'000; ++i) noise.say(GasSupply{});
  });
  for (std::uint64_t seen = 0; seen < 480;)
    if (reader.update()) seen = reader.newest().step;
  for (std::jthread& thread : threads) thread.request_stop();
  for (std::jthread& thread : threads) thread.join();
  dive.simulation->stop();
  EXPECT_TRUE(sinks.finish().ok());
  EXPECT_FALSE(told.empty());
  EXPECT_GE(counter.readings, 120u);  // of 2 s
  EXPECT_EQ(counter.gaps, 0u);
  EXPECT_EQ(dive.simulation->inbox().counts(noise.source).accepted, 20'000u);
  EXPECT_GT(dive.simulation->inbox().counts(suit.source).not_of_stream, 0u);
  EXPECT_FALSE(replay_run(*dive.world, recorded_run(*dive.world, *dive.simulation), "run.mcap")
                   .value()
                   .first_difference.has_value());
}

}  // namespace
}  // namespace neritic::testbed
