#include "engine/sim/simulation.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "tests/sim/replay.hpp"
#include "tests/sim/spring.hpp"

namespace neritic::sim {
namespace {

using test::kNan, test::make_spring, test::replay, test::Spring, test::SpringInputs,
    test::SpringState;

TEST(Simulation, LockStepIsTheStepFunctionRepeated) {
  Spring spring = make_spring({.step_s = 0.01});
  spring.inbox().push({.force_n = 3.0});
  spring.advance(500);
  SpringState expected;
  for (int i = 0; i < 500; ++i) expected = test::spring_step(expected, {.force_n = 3.0}, 0.01);
  EXPECT_EQ(spring.newest().state, expected);
  EXPECT_EQ(spring.newest().step, 500u);
}

TEST(Simulation, AMessageHoldsFromTheNextStepUntilAnotherComes) {
  Spring spring = make_spring();
  spring.advance(10);
  spring.inbox().push({.force_n = 1.0});
  spring.inbox().push({.force_n = 2.0});
  spring.advance(10);
  spring.inbox().push({.force_n = 5.0});
  spring.advance(1);
  const auto& entries = spring.log().entries;
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0].step, 10u);
  EXPECT_EQ(entries[1].step, 10u);
  EXPECT_EQ(entries[1].message.force_n, 2.0);
  EXPECT_EQ(entries[2].step, 20u);
  EXPECT_EQ(spring.inputs().force_n, 5.0);
}

TEST(Simulation, AStepThatIsNotFiniteIsRefusedAndTheStateHolds) {
  Spring spring =
      make_spring({}, [](const SpringState& state, const SpringInputs& inputs, double dt_s) {
        SpringState next = test::spring_step(state, inputs, dt_s);
        if (inputs.kick[0] == 7) next.velocity_m_s = kNan;
        return next;
      });
  spring.advance(5);
  const SpringState before = spring.newest().state;
  spring.inbox().push({.kick = {7, 0}});
  spring.advance(3);
  EXPECT_EQ(spring.newest().state, before);
  EXPECT_EQ(spring.newest().step, 8u);
  EXPECT_EQ(spring.refused_states(), 3u);
  spring.inbox().push({});
  spring.advance(1);
  EXPECT_NE(spring.newest().state, before);
}

TEST(Simulation, AHundredRunsHaveTheSameHashes) {
  std::vector<std::uint64_t> first;
  for (int run = 0; run < 100; ++run) {
    Spring spring = make_spring();
    for (int i = 0; i < 50; ++i) {
      spring.inbox().push({.force_n = std::sin(i * 0.7) * 5.0, .kick = {1, 0}});
      spring.advance(3);
    }
    if (run == 0) first = spring.log().hashes;
    ASSERT_EQ(spring.log().hashes, first) << run;
  }
  EXPECT_EQ(first.size(), 151u);
}

TEST(Simulation, ReplayingTheLogGivesTheSameHashes) {
  Spring spring = make_spring();
  for (int i = 0; i < 200; ++i) {
    if (i % 7 == 0) spring.inbox().push({.force_n = i * 0.1});
    spring.advance(5);
  }
  const ReplayReport report =
      replay(spring.log(), SpringState{}, test::spring_step, test::apply_whole<SpringInputs>);
  EXPECT_EQ(report.steps, 1000u);
  EXPECT_FALSE(report.first_difference.has_value());
}

TEST(Simulation, ReplaySaysWhichStepDiffers) {
  Spring spring = make_spring();
  spring.advance(20);
  spring.inbox().push({.force_n = 1.0});
  spring.advance(20);
  Spring::Log log = spring.log();
  log.entries[0].message.force_n = std::nextafter(1.0, 2.0) + 1e-9;
  EXPECT_EQ(replay(log, SpringState{}, test::spring_step, test::apply_whole<SpringInputs>)
                .first_difference,
            21u);
  EXPECT_EQ(replay(log, SpringState{.position_m = 2.0}, test::spring_step,
                   test::apply_whole<SpringInputs>)
                .first_difference,
            0u);
}

TEST(Simulation, AThreadUnderAShowerOfMessagesReplaysToTheSameHashes) {
  SimulatedClock clock;
  Spring spring = make_spring();
  auto reader = spring.reader();
  std::atomic<bool> done{false};
  spring.start(clock);
  std::thread producer([&] {
    for (int i = 0; !done; ++i) {
      spring.inbox().push({.force_n = std::sin(i * 0.01)});
      std::this_thread::yield();
    }
  });
  std::uint64_t last = 0, backwards = 0, wrong_hashes = 0, torn = 0;
  std::thread second([&, other = spring.reader()]() mutable {
    while (!done) {
      other.update();
      torn += other.newest().hash != state_hash(other.newest().step, other.newest().state);
    }
  });
  while (last < 20'000) {
    if (!reader.update()) continue;
    backwards += reader.newest().step < last;
    last = reader.newest().step;
    wrong_hashes += reader.newest().hash != state_hash(last, reader.newest().state);
  }
  done = true;
  producer.join();
  second.join();
  spring.stop();
  EXPECT_EQ(backwards, 0u);
  EXPECT_EQ(wrong_hashes, 0u);
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(spring.pace().steps, spring.newest().step);
  const ReplayReport report =
      replay(spring.log(), SpringState{}, test::spring_step, test::apply_whole<SpringInputs>);
  EXPECT_EQ(report.steps, spring.newest().step);
  EXPECT_FALSE(report.first_difference.has_value());
}

TEST(Simulation, ARestoredStateGoesOnAsIfItHadNeverStopped) {
  Spring whole = make_spring();
  whole.inbox().push({.force_n = 2.0});
  whole.advance(70);
  const Snapshot<SpringState> saved = whole.newest();
  const SpringInputs inputs = whole.inputs();
  whole.advance(50);
  Spring later = make_spring();
  later.advance(3);
  later.inbox().push({.force_n = -9.0});  // dropped by the restore
  later.restore(saved.step, saved.state, inputs);
  EXPECT_EQ(later.newest().hash, saved.hash);
  later.advance(50);
  EXPECT_EQ(later.newest().hash, whole.newest().hash);
  EXPECT_EQ(later.newest().step, 120u);
  EXPECT_EQ(later.newest().due_ns, whole.newest().due_ns);
  EXPECT_EQ(later.log().first_step, 70u);
  const ReplayReport report =
      replay(later.log(), saved.state, test::spring_step, test::apply_whole<SpringInputs>);
  EXPECT_EQ(report.steps, 50u);
  EXPECT_FALSE(report.first_difference.has_value());
}

TEST(Simulation, ThreadAndLockStepAgreeAndMayTakeTurns) {
  SimulatedClock clock;
  Spring threaded = make_spring();
  threaded.advance(3);
  threaded.start(clock);
  while (threaded.pace().steps < 100) std::this_thread::yield();
  threaded.stop();
  threaded.advance(2);
  Spring stepped = make_spring();
  stepped.advance(threaded.newest().step);
  EXPECT_EQ(stepped.log().hashes, threaded.log().hashes);
}

TEST(Simulation, NoStepFollowsTheOneThatItEndsAt) {
  SimulatedClock clock;
  Spring spring = make_spring();
  spring.end_at(5);
  spring.advance(3);
  spring.start(clock);
  while (spring.pace().steps < 10) std::this_thread::yield();
  spring.stop();
  EXPECT_EQ(spring.newest().step, 5u);
  spring.advance(1);
  EXPECT_EQ(spring.newest().step, 5u);
}

TEST(Simulation, WhatNeedsNoThreadMayNotBeReadWhileItRuns) {
  SimulatedClock clock;
  Spring spring = make_spring();
  EXPECT_DEATH(
      {
        spring.start(clock);
        spring.advance(1);
      },
      "thread runs");
}

TEST(Simulation, RatesOfAThreadAreBounded) {
  SimulatedClock clock;
  EXPECT_DEATH(make_spring({.step_s = 1.0 / 50.0}).start(clock), "Hz");
  EXPECT_DEATH(make_spring({.step_s = 1.0 / 1100.0}).start(clock), "Hz");
}

}  // namespace
}  // namespace neritic::sim
