// A run's time stops, steps, slows down and speeds up, and never falls or jumps.
#include "engine/sim/run_clock.hpp"

#include <gtest/gtest.h>

#include "engine/sim/step_pacer.hpp"

namespace neritic::sim {
namespace {

constexpr TimeNs kSecond_ns = 1'000'000'000;

struct Watched {
  SimulatedClock host{5 * kSecond_ns};
  RunClock run{host};
  double seconds() { return 1e-9 * static_cast<double>(run.now() - 5 * kSecond_ns); }
};

TEST(RunClock, PassesAtItsSpeedWithoutAJumpAtAChange) {
  Watched t;
  t.host.advance(kSecond_ns);
  EXPECT_DOUBLE_EQ(t.seconds(), 1.0);
  t.run.set_speed(0.25);
  EXPECT_DOUBLE_EQ(t.seconds(), 1.0);
  t.host.advance(2 * kSecond_ns);
  EXPECT_DOUBLE_EQ(t.seconds(), 1.5);
  t.run.set_speed(10.0);
  t.host.advance(kSecond_ns);
  EXPECT_DOUBLE_EQ(t.seconds(), 11.5);
  t.run.set_speed(1e9);
  EXPECT_EQ(t.run.speed(), RunClock::kFastest);
  t.run.set_speed(0.0);
  EXPECT_EQ(t.run.speed(), RunClock::kSlowest);
}

TEST(RunClock, StandsWhilePausedAndStepsByJustThat) {
  Watched t;
  t.host.advance(kSecond_ns);
  t.run.pause(true);
  t.host.advance(3600 * kSecond_ns);
  EXPECT_DOUBLE_EQ(t.seconds(), 1.0);
  EXPECT_EQ(t.run.at(t.host.now() + kSecond_ns), t.run.now());
  for (int step = 1; step <= 3; ++step) {
    t.run.step(kSecond_ns / 50);
    t.host.advance(kSecond_ns);
    EXPECT_DOUBLE_EQ(t.seconds(), 1.0 + 0.02 * step);
  }
  t.run.pause(false);
  EXPECT_DOUBLE_EQ(t.seconds(), 1.06);
  t.host.advance(kSecond_ns);
  EXPECT_DOUBLE_EQ(t.seconds(), 2.06);
  t.run.step(kSecond_ns);  // nothing to step while it runs
  EXPECT_DOUBLE_EQ(t.seconds(), 2.06);
}

// Devices stamp by the host's clock: a step's time there is known through pause and speed.
TEST(RunClock, SaysWhenTheHostsClockShowedItsTime) {
  Watched t;
  const auto host_s = [&](double run_s) {
    const auto at_ns = 5 * kSecond_ns + static_cast<TimeNs>(run_s * 1e9);
    return 1e-9 * static_cast<double>(t.run.host_at(at_ns) - 5 * kSecond_ns);
  };
  t.host.advance(kSecond_ns);
  EXPECT_NEAR(host_s(0.9), 0.9, 1e-9);
  t.run.pause(true);
  t.host.advance(10 * kSecond_ns);
  EXPECT_NEAR(host_s(1.0), 11.0, 1e-9);
  t.run.pause(false);
  EXPECT_NEAR(host_s(1.0), 11.0, 1e-9);
  t.host.advance(kSecond_ns);
  EXPECT_NEAR(host_s(1.9), 11.9, 1e-9);
  t.run.set_speed(0.25);
  t.host.advance(4 * kSecond_ns);
  EXPECT_NEAR(host_s(2.5), 14.0, 1e-9);
}

// A wait ends while paused, so that who waits can be stopped; and steps come at the run's pace,
// none dropped.
TEST(RunClock, PacesStepsAndDropsNoneThroughPauseAndSpeed) {
  Watched t;
  StepPacer pacer(240.0, 4, t.run.now());
  int steps = 0;
  const auto pace = [&](TimeNs host_ns) {
    for (const TimeNs end_ns = t.host.now() + host_ns; t.host.now() < end_ns;) {
      steps += pacer.take(t.run.now());
      t.run.wait_until(pacer.next_ns());
    }
  };
  pace(kSecond_ns);
  EXPECT_NEAR(steps, 240, 2);
  t.run.pause(true);
  pace(kSecond_ns);
  EXPECT_NEAR(steps, 240, 2);
  t.run.step(kSecond_ns / 60);
  pace(kSecond_ns);
  EXPECT_NEAR(steps, 244, 2);
  t.run.pause(false);
  t.run.set_speed(4.0);
  pace(kSecond_ns);
  EXPECT_NEAR(steps, 1204, 4);
  EXPECT_EQ(pacer.counts().dropped, 0u);
}

}  // namespace
}  // namespace neritic::sim
