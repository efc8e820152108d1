#include "engine/sim/step_pacer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include "engine/sim/step_clock.hpp"
#include "engine/sim/step_thread.hpp"

namespace neritic::sim {
namespace {

constexpr TimeNs kSecond = 1'000'000'000;

TEST(StepPacer, AnHourAtAnyRateGivesItsStepsToTheNanosecond) {
  for (const double rate_hz : {60.0, 144.0, 240.0, 999.9, 1000.0}) {
    StepPacer pacer(rate_hz, 1'000'000'000, 12345);
    EXPECT_EQ(pacer.take(12345 + 3600 * kSecond), static_cast<int>(std::floor(rate_hz * 3600.0)));
    EXPECT_EQ(pacer.counts().dropped, 0u);
  }
}

TEST(StepPacer, AsksForAStepJustWhenItIsDue) {
  StepPacer pacer(240.0, 4, 0);
  for (int step = 1; step <= 2400; ++step) {
    const TimeNs due = pacer.next_ns();
    EXPECT_EQ(due, std::llround(step * 1e9 / 240.0));
    EXPECT_EQ(pacer.take(due - 1), 0);
    ASSERT_EQ(pacer.take(due), 1);
    EXPECT_EQ(pacer.taken_ns(1, 0), due);
  }
  EXPECT_EQ(pacer.counts().caught_up, 0u);
}

TEST(StepPacer, AShortDelayIsCaughtUp) {
  StepPacer pacer(1000.0, 4, 0);
  EXPECT_EQ(pacer.take(3'500'000), 3);
  EXPECT_EQ(pacer.taken_ns(3, 0), 1'000'000);
  EXPECT_EQ(pacer.taken_ns(3, 2), 3'000'000);
  EXPECT_EQ(pacer.next_ns(), 4'000'000);
  EXPECT_EQ(pacer.counts().steps, 3u);
  EXPECT_EQ(pacer.counts().caught_up, 2u);
  EXPECT_EQ(pacer.counts().dropped, 0u);
}

TEST(StepPacer, ALongDelayIsDroppedAndCounted) {
  StepPacer pacer(1000.0, 4, 0);
  EXPECT_EQ(pacer.take(10 * kSecond + 300'000), 4);
  EXPECT_EQ(pacer.counts().dropped, 9996u);
  EXPECT_EQ(pacer.counts().dropped_ns, 9'996'000'000);
  // The four that run are the latest, and the pace goes on from there.
  EXPECT_EQ(pacer.taken_ns(4, 3), 10 * kSecond);
  EXPECT_EQ(pacer.next_ns(), 10 * kSecond + 1'000'000);
  EXPECT_EQ(pacer.take(10 * kSecond + 1'000'000), 1);
}

TEST(StepPacer, ADelayThatIsCaughtUpSoonCostsNoStep) {
  StepPacer pacer(240.0, 4, 0, 100'000'000);
  const TimeNs stalled_ns = 100'000'000;  // 24 steps
  for (int i = 0; i < 6; ++i) {
    ASSERT_EQ(pacer.take(stalled_ns), 4);
    EXPECT_EQ(pacer.taken_ns(4, 3), std::llround((4 * i + 4) * 1e9 / 240.0));
  }
  EXPECT_EQ(pacer.take(stalled_ns), 0);
  EXPECT_EQ(pacer.counts().caught_up, 23u);
  EXPECT_EQ(pacer.counts().dropped, 0u);
  // Those that are later than that are dropped: a second more is 240 steps.
  EXPECT_EQ(pacer.take(stalled_ns + kSecond), 4);
  EXPECT_EQ(pacer.counts().dropped, 216u);
  EXPECT_EQ(pacer.counts().dropped_ns, std::llround(216e9 / 240.0));
}

TEST(StepPacer, AMachineThatIsTooSlowDropsStepsAndIsNotLateAllTheTime) {
  StepPacer pacer(1000.0, 4, 0, 100'000'000);
  TimeNs now_ns = 0;
  const auto run_until = [&](TimeNs end_ns, TimeNs step_ns) {
    TimeNs latest_ns = 0;
    while (now_ns < end_ns) {
      const int steps = pacer.take(now_ns);
      if (steps == 0) now_ns = pacer.next_ns();
      for (int i = 0; i < steps; ++i) {
        latest_ns = std::max(latest_ns, now_ns - pacer.taken_ns(steps, i));
        now_ns += step_ns;
      }
    }
    return latest_ns;
  };
  // Steps take 1.2 of their period.
  EXPECT_LE(run_until(2 * kSecond, 1'200'000), 105'000'000);
  EXPECT_LE(run_until(10 * kSecond, 1'200'000), 6'000'000);
  EXPECT_NEAR(static_cast<double>(pacer.counts().dropped), 10'000.0 / 6.0, 30.0);
  // Once it is fast again, a delay is caught up as before.
  run_until(11 * kSecond, 100'000);
  const std::uint64_t dropped = pacer.counts().dropped;
  now_ns += 90'000'000;
  run_until(12 * kSecond, 100'000);
  EXPECT_EQ(pacer.counts().dropped, dropped);
}

TEST(StepPacer, AClockThatGoesBackAsksForNothing) {
  StepPacer pacer(240.0, 4, kSecond);
  EXPECT_EQ(pacer.take(0), 0);
  EXPECT_EQ(pacer.take(-kSecond), 0);
  EXPECT_EQ(pacer.take(kSecond + 4'166'667), 1);
}

TEST(StepPacer, AnEarlyStepIsTheNextOneAndIsNotAskedForAgain) {
  StepPacer pacer(1000.0, 4, 0);
  EXPECT_FALSE(pacer.take_early(300'000, 600'000));
  EXPECT_TRUE(pacer.take_early(300'000, 1'000'000));
  EXPECT_EQ(pacer.taken_ns(1, 0), 1'000'000);
  EXPECT_FALSE(pacer.take_early(300'000, 1'000'000)) << "one step ahead at most";
  EXPECT_EQ(pacer.take(1'000'000), 0);
  EXPECT_EQ(pacer.take(2'000'000), 1);
  EXPECT_EQ(pacer.taken_ns(1, 0), 2'000'000);
  EXPECT_EQ(pacer.counts().steps, 2u);
  EXPECT_EQ(pacer.counts().caught_up + pacer.counts().dropped, 0u);
}

// Two threads step; the steps are those of one.
TEST(StepThread, HastenedStepsAreNeitherSkippedNorRunTwice) {
  HostClock clock;
  const TimeNs begun_ns = clock.now();
  std::vector<TimeNs> due;
  std::atomic<int> early{0};
  StepPacer::Counts counts;
  {
    StepThread thread(clock, StepPacer(1000.0, 1000, begun_ns), [&](TimeNs due_ns) {
      if (due_ns > clock.now()) ++early;
      due.push_back(due_ns);
    });
    while (clock.now() < begun_ns + kSecond / 2) {
      thread.hasten(1'000'000, kSecond);
      std::this_thread::sleep_for(std::chrono::microseconds(700));
    }
    thread.stop();
    counts = thread.counts();
  }
  EXPECT_GE(early, 50);
  EXPECT_EQ(counts.dropped, 0u);
  EXPECT_EQ(counts.steps, due.size());
  for (std::size_t i = 0; i < due.size(); ++i)
    ASSERT_EQ(due[i], begun_ns + static_cast<TimeNs>(i + 1) * 1'000'000);
}

// A picture after a stall shows the newest step, not one of the first that are caught up.
TEST(StepThread, AllThatIsLateIsHastened) {
  class Stalled final : public StepClock {
   public:
    TimeNs now() override { return at_ns; }
    void wait_until(TimeNs) override {
      waits = true;
      while (!ends) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::atomic<TimeNs> at_ns{0};
    std::atomic<bool> waits{false}, ends{false};
  } clock;
  std::vector<TimeNs> due;
  StepThread thread(clock, StepPacer(1000.0, 4, 0, 100'000'000),
                    [&](TimeNs due_ns) { due.push_back(due_ns); });
  while (!clock.waits) std::this_thread::yield();
  clock.at_ns = 80'300'000;
  EXPECT_TRUE(thread.hasten(1'000'000, kSecond));
  ASSERT_EQ(due.size(), 81u);
  for (std::size_t i = 0; i < due.size(); ++i)
    EXPECT_EQ(due[i], static_cast<TimeNs>(i + 1) * 1'000'000);
  EXPECT_EQ(thread.counts().dropped, 0u);
  clock.ends = true;
}

TEST(StepThread, NoStepIsHastenedWhileTimeStandsOrStepsAreSlow) {
  class Standing final : public StepClock {
   public:
    TimeNs now() override { return 0; }
    void wait_until(TimeNs) override { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }
    bool stands() override { return standing; }
    std::atomic<bool> standing{true};
  } clock;
  std::atomic<int> steps{0};
  StepThread thread(clock, StepPacer(1000.0, 4, 0), [&](TimeNs) {
    ++steps;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  });
  EXPECT_FALSE(thread.hasten(1'000'000, 1'000'000));
  EXPECT_EQ(steps, 0);
  clock.standing = false;
  bool taken = false;  // the thread may hold the steps just now
  for (int i = 0; i < 1000 && !taken; ++i) {
    taken = thread.hasten(1'000'000, 1'000'000);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(taken);
  EXPECT_EQ(steps, 1);
  EXPECT_FALSE(thread.hasten(10'000'000, 1'000'000)) << "the last step took longer";
  EXPECT_EQ(steps, 1);
}

TEST(StepThread, RunsStepsAtTheirTimesOnASimulatedClock) {
  SimulatedClock clock(5 * kSecond);
  std::vector<TimeNs> due;
  std::atomic<bool> enough{false};
  {
    const StepThread thread(clock, StepPacer(240.0, 4, clock.now()), [&](TimeNs due_ns) {
      if (due.size() < 1000) due.push_back(due_ns);
      enough = due.size() == 1000;
    });
    while (!enough) std::this_thread::yield();
  }
  for (std::size_t i = 0; i < due.size(); ++i)
    ASSERT_EQ(due[i], 5 * kSecond + std::llround(static_cast<double>(i + 1) * 1e9 / 240.0));
}

TEST(StepThread, AStallOfTheMachineIsCountedNotPiledUp) {
  SimulatedClock clock;
  std::atomic<int> steps{0};
  StepPacer::Counts counts;
  {
    const StepThread thread(clock, StepPacer(240.0, 4, 0), [&](TimeNs) {
      // Every hundredth step takes a second.
      if (++steps % 100 == 0) clock.advance(kSecond);
    });
    while (steps < 1000) std::this_thread::yield();
    counts = thread.counts();
    while (counts.steps < 1000) counts = thread.counts();
  }
  const std::uint64_t stalls = counts.steps / 100;
  EXPECT_GE(stalls, 10u);
  // A second is 240 steps: 4 are caught up, 3 of them beyond the one that was due anyway.
  EXPECT_NEAR(static_cast<double>(counts.dropped), 236.0 * static_cast<double>(stalls), 237.0);
  EXPECT_NEAR(static_cast<double>(counts.caught_up), 3.0 * static_cast<double>(stalls), 6.0);
  EXPECT_NEAR(static_cast<double>(counts.dropped_ns),
              static_cast<double>(counts.dropped) * 1e9 / 240.0, 1000.0);
}

}  // namespace
}  // namespace neritic::sim
