// A diver in a scene where everything comes at once: the same bits on a hundred runs, beside busy
// cores, on the physics thread with readers and senders, and from a recorded log; suits that send
// what no body does, buttons and breath gone wild, instruments that say no numbers. Then it swims
// on.
#include <atomic>
#include <limits>
#include <thread>

#include "diver/frames.hpp"
#include "engine/core/random.hpp"
#include "testbed/record/run_record.hpp"
#include "tests/testbed/simulation/replay_run.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

std::string busy_diver_text() {
  const std::string assets = (test::source_dir() / "assets").string();
  return R"(title = "diver and vehicle"
[physics]
[current]
kind = "power_law"
velocity_m_s = [0.1, 0, 0.05]
depth_m = 20
[[objects]]
name = "sand"
class = "seabed"
shape = "plane"
size_m = [60, 60]
position_m = [0, -20, 0]
[[objects]]
name = "diver"
class = "diver"
model = ")" +
         assets + "/models/diver.glb\"\nhuman = \"" + assets + R"(/divers/recreational.toml"
position_m = [0, -12, 0]
pitch_deg = -90
swim = { speed_m_s = 0.45, waypoints_m = [[0, -12, -12], [10, -11, -20]] }
)" + rov_text(R"(
position_m = [2.5, -12, 0]
mission = { follow = { object = "diver", offset_m = [2.5, 0.3, 0] }, look_at = "diver" }
)");
}

const HumanPhysics& human_of(const TestDive& dive) {
  return dive.state().humans()[0];
}

// Impossible data of a suit and its buttons, different for each index.
Suit wild_steering(std::uint64_t index) {
  const RandomKey key{20261105, 7, index};
  std::uint64_t count = 0;
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * random_uniform(key, count++);
  };
  Suit out;
  out.worn = 1;
  for (Quat& q : out.human.joints)
    q = glm::normalize(Quat(uniform(0.1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
  out.human.buttons = static_cast<std::uint64_t>(uniform(0.0, 9.0));  // 8 is none
  out.human.hold_breath = static_cast<std::uint64_t>(uniform(0.0, 3.0));
  out.human.tank = static_cast<std::uint64_t>(uniform(0.0, 6.0));
  out.human.other_power_w = uniform(-1e3, 2e4);
  out.human.ventilation_l_min = uniform(-50.0, 500.0);
  out.human.instruments.heart.time_s = uniform(-1e13, 1e13);
  out.human.instruments.heart.rate_bpm = uniform(-100.0, 500.0);
  out.human.instruments.gaze.direction = {uniform(-3, 3), uniform(-3, 3), uniform(-3, 3)};
  return out;
}

// Its kinetic energy, roughly: what is bounded.
double speed_of(const HumanPhysics& human) {
  return glm::length(human.human.root.velocity.linear());
}

TEST(HumanDiveDeterminism, AHundredRunsHaveTheSameHashes) {
  const TestDive first = dive_of(busy_diver_text());
  const auto run = [&] {
    const auto simulation = first.world->simulation({});
    simulation->advance(240);
    wear(*first.world, *simulation, 0, wild_steering(3));
    simulation->advance(120);
    return simulation->log().hashes;
  };
  const std::vector<std::uint64_t> expected = run();
  ASSERT_EQ(expected.size(), 361u);
  EXPECT_NE(expected.front(), expected.back());
  for (int i = 0; i < 100; ++i) ASSERT_EQ(run(), expected) << i;
}

TEST(HumanDiveDeterminism, TheThreadUnderLoadWithReadersAndSendersReplaysInLockStep) {
  const TestDive dive = dive_of(busy_diver_text());
  const auto simulation = dive.world->simulation({});
  std::atomic<bool> stop{false};
  std::atomic<std::uint64_t> seen{0};
  std::vector<std::thread> others;
  for (int reader = 0; reader < 2; ++reader)
    others.emplace_back([&, reader] {
      auto snapshots = simulation->reader();
      while (!stop) {
        if (!snapshots.update()) continue;
        const PhysicsState& state = snapshots.newest().state;
        if (!sim::all_finite(state)) ADD_FAILURE() << "a snapshot that is not finite";
        if (reader == 0) seen = snapshots.newest().step;
      }
    });
  others.emplace_back([&] {
    for (std::uint64_t i = 0; !stop; ++i) {
      Suit steering = wild_steering(i);
      steering.worn = i % 3 == 0;
      wear(*dive.world, *simulation, 0, steering);
      std::this_thread::yield();
    }
  });
  sim::SimulatedClock clock;
  simulation->start(clock);
  while (seen < 720) std::this_thread::yield();
  simulation->stop();
  stop = true;
  for (std::thread& thread : others) thread.join();
  const auto report = replayed(*dive.world, simulation->log());
  EXPECT_FALSE(report.first_difference.has_value());
  EXPECT_EQ(report.steps, simulation->log().steps());
  EXPECT_GT(simulation->log().entries.size(), 2u);
  EXPECT_EQ(simulation->refused_states(), 0u);
}

TEST(HumanDiveDeterminism, ARecordedDiveReplaysFromItsFile) {
  const test::ScratchFolder scratch;
  TestDive dive = dive_of(busy_diver_text());
  for (std::uint64_t i = 0; i < 20; ++i) {
    Suit steering = wild_steering(i);
    steering.worn = i % 2;
    ASSERT_TRUE(wear(dive, 0, steering));
    dive.run(0.1);
  }
  ASSERT_TRUE(
      write_sample_log(scratch / "dive.mcap", recorded_run(*dive.world, *dive.simulation)).ok());
  auto log = read_sample_log(scratch / "dive.mcap");
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_FALSE(replay_run(*dive.world, *log, "dive.mcap").value().first_difference.has_value());
  for (auto& entry : log->entries)
    if (auto* body = std::get_if<BodyJoints>(&entry.sample.payload))
      body->joints[2] = glm::angleAxis(1.0, Vec3(0.0, 1.0, 0.0));
  EXPECT_TRUE(replay_run(*dive.world, *log, "dive.mcap").value().first_difference.has_value());
}

TEST(HumanDiveExtremes, AWildSuitIsBoundedAndTheDiverSwimsOn) {
  TestDive dive = dive_of(busy_diver_text());
  dive.run(2.0);
  double fastest_m_s = 0.0;
  for (std::uint64_t i = 0; i < 5 * 240; ++i) {
    ASSERT_TRUE(wear(dive, 0, wild_steering(i)));
    dive.run(1.0 / 240.0);
    ASSERT_TRUE(sim::all_finite(dive.state())) << i;
    fastest_m_s = std::max(fastest_m_s, speed_of(human_of(dive)));
  }
  EXPECT_LT(fastest_m_s, 4.0);
  EXPECT_GT(human_of(dive).human.refused_inputs, 1000u);
  EXPECT_GT(human_of(dive).human.far_joints, 1000u);
  EXPECT_EQ(dive.simulation->refused_states(), 0u);
  // The suit is taken off, its buttons have emptied the jacket: where it goes on from once that is
  // made good, and how far it comes.
  ASSERT_TRUE(wear(dive, 0, Suit{}));
  dive.run(60.0);
  const Vec3 from = human_of(dive).human.root.position_ned_m;
  const double to_go = glm::distance(from, dive.world->humans()[0].waypoints_ned_m[0]);
  dive.run(15.0);
  const HumanPhysics& after = human_of(dive);
  EXPECT_TRUE(after.arrived > 0 ||
              glm::distance(after.human.root.position_ned_m,
                            dive.world->humans()[0].waypoints_ned_m[0]) < to_go - 3.0);
  EXPECT_LT(glm::length(after.human.root.velocity.angular()), 1.0);
}

// A diver who breathes from a missing tank gets no gas, and the computer continues.
TEST(HumanDiveExtremes, ATankThatIsNoneHoldsTissuesAndNotTheComputer) {
  TestDive dive = dive_of(busy_diver_text());
  dive.run(3.0);
  Suit steering;
  steering.worn = 1;
  steering.human.joints = diver::rotations_of(diver::streamlined(dive.world->humans()[0].body));
  steering.human.buttons = diver::kInflate;
  steering.human.tank = 3;
  ASSERT_TRUE(wear(dive, 0, steering));
  dive.run(1.5);
  const diver::DiveComputerState before = human_of(dive).human.life.computer;
  dive.run(20.0);
  const diver::HumanState& human = human_of(dive).human;
  const diver::DiveComputerState& computer = human.life.computer;
  EXPECT_GT(before.last.depth_m, human.root.position_ned_m.z + 4.0);  // it has risen
  EXPECT_NEAR(computer.last.depth_m, human.root.position_ned_m.z, 1.5);
  EXPECT_EQ(computer.refused, 0u);
  EXPECT_GT(computer.dive_min, before.dive_min + 0.3);
  EXPECT_EQ(computer.last.gas, 0u);
  EXPECT_EQ(computer.last.breathed, 0u);
  EXPECT_TRUE(sim::same_bits(computer.tissues, before.tissues));
  EXPECT_TRUE(sim::same_bits(computer.oxygen, before.oxygen));
  steering.human.tank = 0;
  ASSERT_TRUE(wear(dive, 0, steering));
  dive.run(15.0);
  EXPECT_EQ(human_of(dive).human.life.computer.last.breathed, 1u);
  EXPECT_FALSE(sim::same_bits(human_of(dive).human.life.computer.tissues, before.tissues));
}

TEST(HumanDiveExtremes, MessagesThatAreNoNumbersNeverComeIn) {
  TestDive dive = dive_of(busy_diver_text()), untouched = dive_of(busy_diver_text());
  std::uint64_t pushed = 0;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()})
    for (int place = 0; place < 4; ++place) {
      Suit steering;
      steering.worn = 1;
      if (place == 0) steering.human.joints[5].y = bad;
      if (place == 1) steering.human.instruments.gaze.direction.z = bad;
      if (place == 2) steering.human.instruments.heart.over_five_minutes.sdnn_ms = bad;
      if (place == 3) steering.human.breath_bias_m3 = bad;
      EXPECT_FALSE(wear(dive, 0, steering));
      ++pushed;
      dive.run(0.05);
      untouched.run(0.05);
    }
  EXPECT_EQ(dive.simulation->inbox().counts(1).refused(), pushed);
  EXPECT_EQ(dive.simulation->newest().hash, untouched.simulation->newest().hash);
}

// Beneath the surface the diver comes up, is held there by what floats it, and goes on living.
TEST(HumanDiveExtremes, FullInflationEndsAtTheSurface) {
  TestDive dive = dive_of(busy_diver_text());
  Suit steering;
  steering.worn = 1;
  steering.human.joints = diver::rotations_of(diver::streamlined(dive.world->humans()[0].body));
  steering.human.buttons = diver::kInflate;
  steering.human.hold_breath = 1;
  ASSERT_TRUE(wear(dive, 0, steering));
  double fastest_m_s = 0.0;
  dive.run(40.0, [&] { fastest_m_s = std::max(fastest_m_s, speed_of(human_of(dive))); });
  const diver::HumanState& human = human_of(dive).human;
  EXPECT_LT(std::abs(human.root.position_ned_m.z), 1.0);
  EXPECT_LT(fastest_m_s, 4.0);
  EXPECT_GT(fastest_m_s, 0.5);
  // Boyle: 2.2 bar, then 1.
  const double held_m3 = dive.world->humans()[0].start.human.life.lungs.volume_m3;
  EXPECT_NEAR(human.life.lungs.volume_m3, 2.2 * held_m3, 0.2 * held_m3);
  EXPECT_TRUE(sim::all_finite(dive.state()));
}

}  // namespace
}  // namespace neritic::testbed
