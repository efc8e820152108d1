#include "engine/sim/snapshot.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "tests/sim/replay.hpp"
#include "tests/sim/spring.hpp"

namespace neritic::sim {
namespace {

TEST(BlendPose, TurnsAtAConstantRateThroughBothAndBeyond) {
  const auto at = [](double angle_rad) {
    return Pose{Vec3(3.0 * angle_rad, 0.0, 1.0),
                glm::angleAxis(angle_rad, glm::normalize(Vec3(1.0, 2.0, -1.0)))};
  };
  for (const double share : {-0.5, 0.0, 0.3, 1.0, 2.5}) {
    const Pose found = blend_pose(at(0.2), at(0.5), share), expected = at(0.2 + 0.3 * share);
    EXPECT_LT(glm::length(found.position_m - expected.position_m), 1e-14);
    EXPECT_GT(std::abs(glm::dot(found.rotation, expected.rotation)), 1.0 - 1e-14) << share;
  }
}

TEST(BlendPose, TakesTheShortWayBetweenQuaternionsOfEitherSign) {
  const Pose a{Vec3(0.0), glm::angleAxis(0.1, Vec3(0.0, 1.0, 0.0))};
  Pose b{Vec3(0.0), glm::angleAxis(0.3, Vec3(0.0, 1.0, 0.0))};
  const Pose middle = blend_pose(a, b, 0.5);
  b.rotation = -b.rotation;
  EXPECT_GT(std::abs(glm::dot(blend_pose(a, b, 0.5).rotation, middle.rotation)), 1.0 - 1e-15);
  EXPECT_NEAR(glm::angle(middle.rotation), 0.2, 1e-14);
}

TEST(BlendPose, EqualPosesStay) {
  const Pose pose{Vec3(1.0, 2.0, 3.0), glm::angleAxis(1.0, Vec3(1.0, 0.0, 0.0))};
  const Pose found = blend_pose(pose, pose, 0.37);
  EXPECT_EQ(found.position_m, pose.position_m);
  EXPECT_EQ(found.rotation, pose.rotation);
}

TEST(SnapshotReader, LockStepGivesTheNewestTwoStatesWithTheirTimes) {
  auto spring = test::make_spring();
  auto reader = spring.reader();
  EXPECT_FALSE(reader.update());
  EXPECT_EQ(reader.newest().state, test::SpringState{});
  spring.advance(7);
  const test::SpringState older = spring.newest().state;
  spring.advance(1);
  const test::SpringState newer = spring.newest().state;
  ASSERT_TRUE(reader.update());
  EXPECT_EQ(reader.newest().step, 8u);
  EXPECT_DOUBLE_EQ(reader.newest().time_s, 8.0 / 240.0);
  EXPECT_EQ(reader.newest().hash, state_hash(8, newer));
  const TimeNs from = reader.previous().due_ns, to = reader.newest().due_ns;
  EXPECT_EQ(to, 33'333'333);
  EXPECT_EQ(from, 29'166'667);
  EXPECT_EQ(reader.previous().state, older);
  EXPECT_EQ(reader.newest().state, newer);
}

TEST(SnapshotReader, EveryReaderHasItsOwnEnd) {
  auto spring = test::make_spring();
  auto first = spring.reader(), second = spring.reader();
  spring.advance(1);
  EXPECT_TRUE(first.update());
  spring.advance(1);
  EXPECT_TRUE(second.update());
  EXPECT_EQ(first.newest().step, 1u);
  EXPECT_EQ(second.newest().step, 2u);
}

TEST(SnapshotReader, ComesWithTheNewestTwoAndLeavesTheOthersAlone) {
  auto spring = test::make_spring();
  spring.advance(5);
  auto first = spring.reader();
  EXPECT_EQ(first.newest().step, 5u);
  EXPECT_EQ(first.previous().step, 4u);
  EXPECT_FALSE(first.update());
  {
    const auto second = spring.reader();
    spring.advance(1);
  }
  spring.advance(1);
  EXPECT_TRUE(first.update());
  EXPECT_EQ(first.newest().step, 7u);
}

// Four threads make and drop readers while a fifth steps: each sees whole, ascending snapshots.
TEST(SnapshotReader, ComesAndGoesWhileTheThreadRuns) {
  SimulatedClock clock;
  auto spring = test::make_spring();
  spring.start(clock);
  std::atomic<std::uint64_t> faults{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      std::uint64_t last = 0;
      for (int reader_number = 0; reader_number < 200; ++reader_number) {
        auto reader = spring.reader();
        for (int look = 0; look < 3; ++look) {
          const auto& newest = reader.newest();
          if (newest.step < last || newest.hash != state_hash(newest.step, newest.state)) ++faults;
          last = newest.step;
          reader.update();
        }
      }
    });
  for (std::thread& thread : threads) thread.join();
  spring.stop();
  EXPECT_EQ(faults, 0u);
  const ReplayReport report = test::replay(spring.log(), test::SpringState{}, test::spring_step,
                                           test::apply_whole<test::SpringInputs>);
  EXPECT_FALSE(report.first_difference.has_value());
}

TEST(SnapshotReader, LeftBehindByItsSimulationIsABug) {
  EXPECT_DEATH(
      {
        auto spring = std::make_unique<test::Spring>(
            SimulationOptions{}, test::SpringState{}, test::SpringInputs{},
            std::make_unique<test::PlainInbox<test::SpringInputs>>(), test::spring_step,
            test::apply_whole<test::SpringInputs>);
        auto reader = spring->reader();
        spring.reset();
      },
      "readers left");
}

}  // namespace
}  // namespace neritic::sim
