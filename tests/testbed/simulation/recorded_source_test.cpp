// A recording as the source of one group of a diver while others are live or the autopilot's, and
// as the source of a whole run.
#include "testbed/samples/recorded_source.hpp"

#include "testbed/record/run_record.hpp"
#include "tests/testbed/simulation/devices.hpp"
#include "tests/testbed/simulation/replay_run.hpp"

namespace neritic::testbed {
namespace {

BodyJoints posture(std::uint64_t step) {
  BodyJoints body;
  body.joints[0] = glm::angleAxis(0.3 * std::sin(0.02 * double(step)), Vec3(0.0, 1.0, 0.0));
  return body;
}

// A suit at 240 Hz and controllers at 10 Hz, for these steps.
SampleLog recorded_dive(std::uint64_t steps) {
  TestDive dive = dive_of(hover_text("body = \"suit\", buttons = \"controllers\""));
  Device suit(dive, "suit", "diver/joints"), controllers(dive, "controllers", "diver/buttons");
  for (std::uint64_t step = 0; step < steps; ++step) {
    suit.say(posture(step));
    if (step % 24 == 0) controllers.say(JacketButtons{diver::kDeflate});
    dive.simulation->advance(1);
  }
  return recorded_run(*dive.world, *dive.simulation);
}

TEST(RecordedSource, DrivesOneGroupWhileAnotherIsLiveAndTheRestIsTheAutopilots) {
  TestDive dive = dive_of(hover_text("body = \"suit\", buttons = \"gamepad\", heart = \"strap\""));
  RecordedSource recording =
      RecordedSource::create(recorded_dive(240), dive.world->streams(), "suit.mcap").value();
  Device live(dive, "gamepad", "diver/buttons");
  for (std::uint64_t step = 0; step < 240; ++step) {
    ASSERT_TRUE(recording.poll(dive.simulation->inbox(), dive.time_s()).ok());
    live.say(JacketButtons{diver::kInflate});
    dive.simulation->advance(1);
    const DiverInputs& inputs = dive.simulation->inputs().humans()[0];
    ASSERT_EQ(inputs.body.joints[0].y, posture(step).joints[0].y) << step;
    ASSERT_EQ(inputs.buttons.pressed, diver::kInflate) << step;
  }
  EXPECT_TRUE(recording.done());
  EXPECT_EQ(group(dive, DiverGroup::kBody).phase, GroupPhase::kLive);
  EXPECT_EQ(group(dive, DiverGroup::kBody).heard, 240u);
  EXPECT_EQ(group(dive, DiverGroup::kGas).authority, Authority::kAutopilot);
  // The recorded controllers have no authority here.
  EXPECT_EQ(group(dive, DiverGroup::kButtons).heard, 240u);
  EXPECT_EQ(group(dive, DiverGroup::kButtons).unheeded, 10u);
  EXPECT_EQ(
      dive.simulation->inbox().source_names()[group(dive, DiverGroup::kButtons).unheeded_source],
      "controllers");
  // After its end the recording is a source that fell silent.
  for (int step = 0; step < 240; ++step) dive.simulation->advance(1);
  EXPECT_EQ(group(dive, DiverGroup::kBody).phase, GroupPhase::kLost);
  EXPECT_EQ(acting(group(dive, DiverGroup::kBody)), Authority::kAutopilot);
}

// The suit restarts: it counts from 0 again, and its clock is behind. Sources have other numbers
// in the inbox of the repeated run's scene than names are opened in.
TEST(RecordedSource, RepeatsARunInWhichADeviceWasRestartedAndAGroupHandedOver) {
  TestDive dive = dive_of(hover_text("body = \"suit\""));
  Device controllers(dive, "controllers", "diver/buttons"), events(dive, "operator", "diver/event");
  std::uint64_t step = 0;
  for (int start = 0; start < 3; ++start) {
    Device suit(dive, "suit", "diver/joints");
    for (int i = 0; i < 100; ++i, ++step) {
      suit.say(posture(step));
      if (step == 120)
        events.say(Event{EventKind::kSetAuthority, static_cast<std::uint64_t>(DiverGroup::kButtons),
                         static_cast<std::uint64_t>(Authority::kLive), controllers.source, 0.4});
      controllers.say(JacketButtons{diver::kInflate});
      dive.simulation->advance(1);
    }
  }
  EXPECT_EQ(group(dive, DiverGroup::kButtons).heard, 180u);
  const SampleLog log = recorded_run(*dive.world, *dive.simulation);
  ASSERT_EQ(log.entries.size(), 601u);
  const auto report = replay_run(*dive.world, log, "run.mcap").value();
  EXPECT_EQ(report.steps, 300u);
  EXPECT_FALSE(report.first_difference.has_value());
}

TEST(RecordedSource, ALogThatNoInboxTakesIsRefusedInOneLine) {
  const TestDive dive = dive_of(hover_text("body = \"suit\""));
  SampleLog log = recorded_dive(3);
  log.entries[1].sample.header.captured_ns = 1'000'000'000;  // after its arrival
  log.entries[1].sample.header.arrived_ns = 0;
  EXPECT_EQ(replay_run(*dive.world, log, "run.mcap").error().message,
            "run.mcap: diver/buttons at step 0: sample 0 is late; accepted: samples as an inbox "
            "takes them");
  log.step_s *= 2.0;
  EXPECT_EQ(replay_run(*dive.world, log, "run.mcap").error().message,
            fmt::format("run.mcap: steps of {} s; accepted: {} s, as in the scene", log.step_s,
                        dive.world->step_s()));
}

}  // namespace
}  // namespace neritic::testbed
