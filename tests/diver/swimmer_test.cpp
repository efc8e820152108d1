// A diver who swims to places: on the way, at the depth, with what that costs; the same bits each
// time; and what a step costs the machine.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/diver/swims.hpp"
#include "tests/sim/plain_inbox.hpp"
#include "tests/sim/replay.hpp"
#include "tests/support/cpu_time.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

static_assert(std::is_trivially_copyable_v<HumanState> &&
              std::is_trivially_copyable_v<HumanInputs> &&
              std::is_trivially_copyable_v<SwimmerState>);

TEST(Swimmer, HoldsDepthHeadingAndPace) {
  const Body body = body_with(Gear{});
  Swim s = begin(body, {0.0, 0.0, 15.0}, 0.0);
  double deepest = 0.0, highest = 100.0, aside = 0.0, roll = 0.0;
  swim_for(body, s, {{1000.0, 0.0, 15.0}, 0.45}, 60.0, [&](const HumanState& state) {
    const Vec3& p = state.root.position_ned_m;
    deepest = std::max(deepest, p.z), highest = std::min(highest, p.z);
    aside = std::max(aside, std::abs(p.y));
    roll = std::max(roll, std::abs(attitude_of(state.root.attitude).roll_rad));
  });
  EXPECT_LT(deepest, 15.6);
  EXPECT_GT(highest, 14.4);
  EXPECT_LT(aside, 0.5);
  EXPECT_LT(degrees(roll), 20.0);
  EXPECT_NEAR(s.state.root.position_ned_m.x / 60.0, 0.44, 0.04);
  // A person's effort, and a breath to match.
  EXPECT_GT(s.state.life.limb_power_w, 30.0);
  EXPECT_LT(s.state.life.limb_power_w, 150.0);
  const GasReading gas = read_gas(body, s.state);
  EXPECT_GT(gas.ventilation_l_min, 15.0);
  EXPECT_LT(gas.ventilation_l_min, 40.0);
  EXPECT_LT(gas.tank_pa, 199e5);
}

// Metres a beat of who swims straight ahead by its own steering, all joints free; the last half of
// a minute. Watts of the limbs over the cube of the beats a second.
struct SteeredKick {
  double m_a_beat = 0.0, watts_at_1_hz = 0.0, roll_deg = 0.0;
};
SteeredKick steered_kick(const Gear& gear, double amplitude_m, double speed_m_s) {
  const Body body = body_with(gear);
  SwimmerSettings settings;
  settings.kick.amplitude_m = amplitude_m;
  Swim s = begin(body, {0.0, 0.0, 15.0}, 0.0);
  double way_m = 0.0, beats = 0.0, work_j = 0.0;
  SteeredKick out;
  for (int i = 0; i < 60 * 240; ++i) {
    if (i == 30 * 240) work_j = s.state.life.limb_work_j;
    swim(body, settings, {{1000.0, 0.0, 15.0}, speed_m_s}, s.state, s.swimmer, 1.0 / 240.0,
         s.inputs);
    s.state = step(body, s.state, s.inputs, 1.0 / 240.0);
    if (i < 30 * 240) continue;
    way_m += s.state.root.velocity[0] / 240.0;
    beats += s.swimmer.frequency_hz / 240.0;
    out.roll_deg =
        std::max(out.roll_deg, std::abs(degrees(attitude_of(s.state.root.attitude).roll_rad)));
  }
  EXPECT_LT(std::abs(s.state.root.position_ned_m.z - 15.0), 0.3);
  out.m_a_beat = way_m / beats;
  out.watts_at_1_hz = (s.state.life.limb_work_j - work_j) / 30.0 / std::pow(beats / 30.0, 3.0);
  return out;
}

// The swimmer with all joints, not the kick alone: the published 0.93 and 0.51 m per beat (Zamparo
// et al. 2002) with fins and without, and a person's power. Steering leaves the kick its thrust.
TEST(Swimmer, ItsKickGivesWhatIsPublishedWithFinsAndBare) {
  for (const double speed_m_s : {0.45, 0.6, 0.8})
    EXPECT_NEAR(steered_kick(fins_only(), 0.20, speed_m_s).m_a_beat, 0.93, 0.10) << speed_m_s;
  EXPECT_NEAR(steered_kick(no_gear(), 0.20, 0.45).m_a_beat, 0.51, 0.08);
  for (const double speed_m_s : {0.3, 0.45, 0.6}) {
    const SteeredKick kick = steered_kick(Gear{}, FlutterKick{}.amplitude_m, speed_m_s);
    EXPECT_NEAR(kick.m_a_beat, 0.52, 0.02) << speed_m_s;
    EXPECT_NEAR(kick.watts_at_1_hz, 105.0, 10.0) << speed_m_s;
    EXPECT_LT(kick.roll_deg, 8.0);
  }
}

// A wide kick as fast as it may be would take kilowatts: the swimmer beats more slowly.
TEST(Swimmer, KicksNoHarderThanAPersonCan) {
  const Body body = body_with(Gear{});
  SwimmerSettings settings;
  settings.kick.amplitude_m = 0.6;
  settings.most_frequency_hz = 3.0;
  Swim s = begin(body, {0.0, 0.0, 15.0}, 0.0);
  double most_w = 0.0, half_j = 0.0;
  for (int i = 0; i < 60 * 240; ++i) {
    swim(body, settings, {{1000.0, 0.0, 15.0}, 1.2}, s.state, s.swimmer, 1.0 / 240.0, s.inputs);
    s.state = step(body, s.state, s.inputs, 1.0 / 240.0);
    if (i == 30 * 240) half_j = s.state.life.limb_work_j;
    if (i > 10 * 240) most_w = std::max(most_w, s.state.life.limb_power_w);
  }
  EXPECT_NEAR((s.state.life.limb_work_j - half_j) / 30.0, 280.0, 25.0);  // and tires
  EXPECT_LT(most_w, 450.0);
}

TEST(Swimmer, TurnsAndDivesToItsGoal) {
  const Body body = body_with(Gear{});
  for (const Vec3 goal : {Vec3(0.0, 14.0, 12.0), Vec3(-12.0, 3.0, 18.0), Vec3(10.0, -10.0, 16.0)}) {
    Swim s = begin(body, {0.0, 0.0, 15.0}, 0.0);
    double nearest = 100.0;
    swim_for(body, s, {goal, 0.45}, 75.0, [&](const HumanState& state) {
      nearest = std::min(nearest, glm::distance(state.root.position_ned_m, goal));
    });
    EXPECT_LT(nearest, 1.2) << goal.x << " " << goal.y << " " << goal.z;
  }
}

TEST(Swimmer, SwimsAcrossACurrent) {
  const Body body = body_with(Gear{});
  Swim s = begin(body, {0.0, 0.0, 15.0}, 0.0);
  s.inputs.current_ned_m_s = {0.0, 0.15, 0.0};
  double aside = 0.0;
  swim_for(body, s, {{60.0, 0.0, 15.0}, 0.5}, 60.0, [&](const HumanState& state) {
    aside = std::max(aside, std::abs(state.root.position_ned_m.y));
  });
  EXPECT_LT(aside, 3.0);
  EXPECT_GT(s.state.root.position_ned_m.x, 20.0);
}

// Oxygen of who fins along, by the work of the limbs: Pendergast's line (2003, average fins),
// within a fifth at a diver's pace. Faster it takes more than people do (CHECKS.md).
TEST(Swimmer, AtADiversPaceItTakesTheOxygenThatIsPublished) {
  const Body body = body_with(Gear{});
  for (const double speed_m_s : {0.35, 0.4, 0.45}) {
    Swim s = begin(body, {0.0, 0.0, 12.0}, 0.0);
    const SwimGoal goal{{1000.0, 0.0, 12.0}, speed_m_s};
    swim_for(body, s, goal, 180.0, [](const HumanState&) {});
    double way_m = 0.0;
    swim_for(body, s, goal, 20.0,
             [&](const HumanState& state) { way_m += state.root.velocity[0] / 240.0; });
    const double published_l_min = swimming_oxygen_l_min(way_m / 20.0);
    EXPECT_NEAR(s.state.life.lungs.oxygen_l_min / published_l_min, 1.0, 0.2) << speed_m_s;
  }
}

// Why fast swims cost more than published is not the kick: wider or narrower, of a shorter or
// longer wave, beating more with the whole leg or with the tips, at 0.6 m/s none takes less.
TEST(Swimmer, NoOtherKickTakesLessAtThatSpeed) {
  const Body body = body_with(Gear{});
  const auto watts = [&](const FlutterKick& kick) {
    SwimmerSettings settings;
    settings.kick = kick;
    settings.most_frequency_hz = 2.5;
    Swim s = begin(body, {0.0, 0.0, 12.0}, 0.0);
    double half_j = 0.0, way_m = 0.0;
    for (int i = 0; i < 60 * 240; ++i) {
      if (i == 30 * 240) half_j = s.state.life.limb_work_j;
      if (i % 4 == 0)
        swim(body, settings, {{1000.0, 0.0, 12.0}, 0.6}, s.state, s.swimmer, 1.0 / 60.0, s.inputs);
      s.state = step(body, s.state, s.inputs, 1.0 / 240.0);
      if (i >= 30 * 240) way_m += s.state.root.velocity[0] / 240.0;
    }
    // As if at 0.6 m/s, where a kick does not get there: power goes with the cube.
    return (s.state.life.limb_work_j - half_j) / 30.0 * std::pow(0.6 * 30.0 / way_m, 3.0);
  };
  const double usual_w = watts({});
  EXPECT_NEAR(usual_w, 175.0, 10.0);
  std::vector<FlutterKick> others(6);
  others[0].amplitude_m = 0.18, others[1].amplitude_m = 0.32;
  others[2].wavelength_m = 1.8, others[3].wavelength_m = 3.2;
  others[4].exponent = 1.0, others[5].exponent = 1.6;
  for (std::size_t i = 0; i < others.size(); ++i) EXPECT_GT(watts(others[i]), usual_w) << i;
}

TEST(Swimmer, FollowsADepthThatChanges) {
  // Down by five metres and up again, each within a minute and a half, filling and emptying the
  // jacket on the way.
  const Body body = body_with(Gear{});
  Swim s = begin(body, {0.0, 0.0, 10.0}, 0.0);
  const auto nothing = [](const HumanState&) {};
  swim_for(body, s, {{1000.0, 0.0, 15.0}, 0.45}, 90.0, nothing);
  EXPECT_NEAR(s.state.root.position_ned_m.z, 15.0, 1.2);
  const double filled = s.state.life.jacket_moles;
  swim_for(body, s, {{1000.0, 0.0, 10.0}, 0.45}, 90.0, nothing);
  EXPECT_NEAR(s.state.root.position_ned_m.z, 10.0, 1.2);
  EXPECT_GT(filled, 0.0);
}

std::uint64_t swim_hash(const Body& body) {
  Swim s = begin(body, {0.0, 0.0, 15.0}, 30.0);
  swim_for(body, s, {{20.0, 5.0, 14.0}, 0.5}, 4.0, [](const HumanState&) {});
  return sim::state_hash(s.state);
}

TEST(DiverDeterminism, HasOneHashOnAHundredRunsAndFourThreads) {
  const Body body = body_with(Gear{});
  const std::uint64_t first = swim_hash(body);
  for (int i = 0; i < 96; ++i) ASSERT_EQ(swim_hash(body), first) << i;
  std::array<std::uint64_t, 4> hashes{};
  std::vector<std::thread> threads;
  for (std::uint64_t& hash : hashes) threads.emplace_back([&] { hash = swim_hash(body); });
  for (std::thread& thread : threads) thread.join();
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, first);
}

TEST(DiverDeterminism, AReplayOfItsInputsGivesTheSameHashes) {
  const Body body = body_with(Gear{});
  const auto pure = [&](const HumanState& s, const HumanInputs& in, double dt) {
    return step(body, s, in, dt);
  };
  const HumanState start = begin(body, {0.0, 0.0, 15.0}, 0.0).state;
  auto simulation =
      sim::test::plain_simulation({.step_s = 1.0 / 240.0}, start, HumanInputs{}, pure);
  SwimmerState swimmer;
  HumanInputs inputs;
  for (int i = 0; i < 300; ++i) {
    swim(body, SwimmerSettings{}, {{10.0, 4.0, 14.0}, 0.5}, simulation.newest().state, swimmer,
         1.0 / 60.0, inputs);
    simulation.inbox().push(inputs);
    simulation.advance(4);
  }
  EXPECT_FALSE(sim::test::replay(simulation.log(), start, pure, sim::test::apply_whole<HumanInputs>)
                   .first_difference.has_value());
  EXPECT_EQ(simulation.refused_states(), 0u);
  EXPECT_GT(simulation.newest().state.root.position_ned_m.x, 1.0);
}

// The diver on the physics thread, a suit that sends and two who read: what the thread made of it
// replays.
TEST(DiverDeterminism, OnItsThreadWithReadersAndSendersItReplays) {
  const Body body = body_with(Gear{});
  const auto pure = [&](const HumanState& s, const HumanInputs& in, double dt) {
    return step(body, s, in, dt);
  };
  const HumanState start = begin(body, {0.0, 0.0, 15.0}, 0.0).state;
  auto simulation =
      sim::test::plain_simulation({.step_s = 1.0 / 240.0}, start, HumanInputs{}, pure);
  std::atomic<bool> stop{false};
  std::atomic<std::uint64_t> seen{0};
  std::atomic<bool> measured{false};
  std::atomic<int> pushed{0};
  std::vector<std::thread> others;
  for (int reader = 0; reader < 2; ++reader)
    others.emplace_back([&, reader] {
      auto snapshots = simulation.reader();
      while (!stop)
        if (snapshots.update()) {
          if (!sim::all_finite(snapshots.newest().state)) ADD_FAILURE() << "not finite";
          if (reader != 0) continue;
          seen = snapshots.newest().step;
          measured = snapshots.newest().state.life.vitals.measured == kHeartMeasured;
        }
    });
  others.emplace_back([&] {
    HumanDraws draws(12);
    HumanInputs inputs;
    while (!stop) {
      inputs.joints = rotations_of(draws.angles(0.5));
      inputs.buttons = static_cast<std::uint64_t>(draws.uniform(0.0, 8.0));
      inputs.instruments.heart.time_s += 1.0;
      inputs.instruments.heart.rate_bpm = draws.uniform(50.0, 180.0);
      inputs.instruments.heart.quality = SignalQuality::kGood;
      simulation.inbox().push(inputs);
      ++pushed;
      std::this_thread::yield();
    }
  });
  sim::SimulatedClock clock;
  simulation.start(clock);
  // Two seconds take 6 ms of the thread: a loaded machine may not have let the suit send in them.
  while (seen < 480 || !measured || pushed < 100) std::this_thread::yield();
  const std::uint64_t then = seen;
  while (seen < then + 240) std::this_thread::yield();
  simulation.stop();
  stop = true;
  for (std::thread& thread : others) thread.join();
  EXPECT_FALSE(sim::test::replay(simulation.log(), start, pure, sim::test::apply_whole<HumanInputs>)
                   .first_difference.has_value());
  EXPECT_GT(simulation.log().entries.size(), 2u);
  EXPECT_EQ(simulation.newest().state.life.vitals.measured, kHeartMeasured);
  EXPECT_EQ(simulation.refused_states(), 0u);
}

// One diver with everything at 240 Hz takes under 1 % of a core: 10 ms of its time a second, the
// least of several, whoever else is at work (3.1 ms on an AMD EPYC).
TEST(DiverSpeed, ASecondOfADiverTakesMilliseconds) {
  const Body body = body_with(Gear{});
  const double least_ms = test::least_cpu_ms(10.0, [&] {
    Swim s = begin(body, {0.0, 0.0, 15.0}, 0.0);
    swim_for(body, s, {{1000.0, 0.0, 15.0}, 0.5}, 1.0, [](const HumanState&) {});
  });
  RecordProperty("ms_a_second", fmt::format("{:.2f}", least_ms));
  if (test::kFast) {
    EXPECT_LT(least_ms, 10.0);
  }
}

}  // namespace
}  // namespace neritic::diver
