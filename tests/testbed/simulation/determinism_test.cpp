// The same scene gives the same states: on many runs, in lock-step and on a thread, under load, and
// from a recorded log; and another pilot gives others.
#include <cmath>
#include <thread>

#include "testbed/record/dive_record.hpp"
#include "testbed/record/run_record.hpp"
#include "tests/testbed/simulation/replay_run.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

// Current, contacts, a mission and a lost thruster: all that a step does.
std::string busy_text() {
  return std::string(R"([physics]
[current]
kind = "power_law"
velocity_m_s = [0.3, 0, 0.1]
depth_m = 12
[[objects]]
name = "sand"
class = "seabed"
shape = "plane"
size_m = [40, 40]
position_m = [0, -12, 0]
[[objects]]
name = "wall"
class = "structure"
shape = "box"
size_m = [6, 4, 0.5]
position_m = [0, -10, -3]
)") + rov_text(R"(
position_m = [0, -11, 0]
failed_thrusters = [3]
mission = { waypoints = [ { position_m = [0, -10.5, -4] }, { position_m = [2, -8, 1] } ] }
)") + rov_text("position_m = [3, -11.5, 1]\nroll_deg = 30\n", "adrift");
}

std::vector<std::uint64_t> hashes_of(TestDive& dive, double seconds) {
  dive.run(seconds);
  return dive.simulation->log().hashes;
}

TEST(PhysicsDeterminism, AHundredRunsHaveTheSameHashes) {
  const TestDive first = dive_of(busy_text());
  const auto run = [&] {
    const auto simulation = first.world->simulation({});
    simulation->advance(5 * 240);
    return simulation->log().hashes;
  };
  const std::vector<std::uint64_t> expected = run();
  ASSERT_EQ(expected.size(), 1201u);
  EXPECT_NE(expected.front(), expected.back());
  for (int i = 0; i < 100; ++i) ASSERT_EQ(run(), expected) << i;
}

TEST(PhysicsDeterminism, ASceneReadAgainGivesTheSameHashes) {
  TestDive a = dive_of(busy_text()), b = dive_of(busy_text());
  EXPECT_EQ(hashes_of(a, 10.0), hashes_of(b, 10.0));
  EXPECT_GT(a.vehicle(0).contact.touched_steps, 0u);  // the wall was met
}

TEST(PhysicsDeterminism, AThreadUnderLoadStepsAsLockStepDoes) {
  TestDive locked = dive_of(busy_text());
  const TestDive threaded = dive_of(busy_text());
  std::atomic<bool> stop{false};
  std::vector<std::thread> load;
  for (int i = 0; i < 3; ++i)
    load.emplace_back([&stop] {
      for (volatile double x = 1.0; !stop;) x = x * 1.0000001;
    });
  sim::SimulatedClock clock;
  auto reader = threaded.simulation->reader();
  threaded.simulation->start(clock);
  std::uint64_t seen = 0;
  while (seen < 1200) {
    if (reader.update()) seen = reader.newest().step;
  }
  threaded.simulation->stop();
  stop = true;
  for (std::thread& thread : load) thread.join();
  const auto& hashes = threaded.simulation->log().hashes;
  locked.simulation->advance(threaded.simulation->log().steps());
  EXPECT_EQ(hashes, locked.simulation->log().hashes);
}

// One thread pilots, one steps, one reads: what was recorded replays to the same bits.
TEST(PhysicsDeterminism, APilotAndAReaderBesideTheThreadThatSteps) {
  const TestDive dive = dive_of(busy_text());
  sim::SimulatedClock clock;
  auto reader = dive.simulation->reader();
  dive.simulation->start(clock);
  std::jthread sender([&](const std::stop_token& stop) {
    for (std::uint64_t i = 0; !stop.stop_requested(); ++i) {
      Piloting inputs;
      inputs.piloted = i % 3 == 0 ? 0 : 1;
      inputs.pilot[i % 6] = i % 17 == 0 ? std::nan("") : 5.0 * std::sin(0.1 * double(i));
      pilot(dive, static_cast<std::uint32_t>(i % 2), inputs);
      std::this_thread::yield();
    }
  });
  std::uint64_t seen = 0;
  while (seen < 1200) {
    if (!reader.update()) continue;
    ASSERT_GE(reader.newest().step, seen);
    seen = reader.newest().step;
    ASSERT_TRUE(sim::all_finite(reader.newest().state));
  }
  sender.request_stop();
  sender.join();
  dive.simulation->stop();
  EXPECT_GT(dive.simulation->inbox().counts(1).refused(), 0u);
  EXPECT_GT(dive.simulation->log().entries.size(), 1u);
  const auto report = replayed(*dive.world, dive.simulation->log());
  EXPECT_GE(report.steps, 1200u);
  EXPECT_FALSE(report.first_difference.has_value());
}

TEST(PhysicsDeterminism, ARecordedDiveWithAPilotReplays) {
  const test::ScratchFolder scratch;
  TestDive dive = dive_of(busy_text());
  dive.run(1.0);
  Piloting inputs;
  inputs.piloted = 1;
  inputs.pilot[0] = 30.0;
  inputs.failed_thrusters = 2;
  pilot(dive, 0, inputs);
  dive.run(2.0);
  inputs.pilot[5] = -4.0;
  pilot(dive, 1, inputs);
  dive.run(2.0);
  ASSERT_TRUE(
      write_sample_log(scratch / "dive.mcap", recorded_run(*dive.world, *dive.simulation)).ok());
  auto log = read_sample_log(scratch / "dive.mcap");
  ASSERT_TRUE(log.ok()) << log.error().message;
  const auto report = replay_run(*dive.world, *log, "dive.mcap").value();
  EXPECT_EQ(report.steps, 1200u);
  EXPECT_FALSE(report.first_difference.has_value());
  auto& wrench = std::get<VehicleWrench>(log->entries[3].sample.payload);
  EXPECT_EQ(wrench.wrench[0], 30.0);
  wrench.wrench[0] = 35.0;
  const auto other = replay_run(*dive.world, *log, "dive.mcap").value();
  ASSERT_TRUE(other.first_difference.has_value());
  EXPECT_GT(*other.first_difference, 240u);
  EXPECT_LT(*other.first_difference, 260u);
}

TEST(PhysicsDeterminism, TheStateNamesEveryByte) {
  sim::check_fields_cover(PhysicsState(3, 2, 2, 2, 1, 2, 2, 1, 2, 3, 2, 2, 5, 2, 3, 2));
  sim::check_fields_cover(PhysicsInputs(3, 2, 1, 2, 2, 3, 2));
}

}  // namespace
}  // namespace neritic::testbed
