// The loop without sensors: which steps its sinks see, how a run ends, and what its clock says.
#include "testbed/loop/loop.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "engine/core/files.hpp"
#include "testbed/record/file_sinks.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

class LoopTest : public testing::Test {
 protected:
  void SetUp() override {
    const test::ScratchFolder scratch;
    const std::string dynamics =
        (test::source_dir() / "assets/vehicles/bluerov2_heavy_survey_dynamics.toml").string();
    ASSERT_TRUE(
        write_text(scratch / "s.toml",
                   "[physics]\n[[vehicles]]\nname = \"rov\"\nshape = \"box\"\ndynamics = \"" +
                       dynamics + "\"\nposition_m = [0, -6, 0]\n")
            .ok());
    scene_ = scene::load_scene(scratch / "s.toml").value();
  }
  std::unique_ptr<LivePhysics> physics(LivePhysics::Pace pace = LivePhysics::Pace::kPicture) const {
    return LivePhysics::create(scene_, pace).value();
  }

  scene::Scene scene_;
};

// Keeps the steps and the readings of the vehicle's depth sensor; fails at a step.
class Listener final : public StepSink {
 public:
  explicit Listener(const PhysicsWorld& world, std::uint64_t fails_at = UINT64_MAX)
      : stream_(world.streams().find("rov/pressure").value()), fails_at_(fails_at) {}
  std::vector<StreamId> streams() const override { return {stream_}; }
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override {
    steps.push_back(step.step);
    hashes.push_back(step.hash);
    for (const Sample& sample : outputs) readings += sample.header.stream == stream_;
    if (step.step == fails_at_) return failure(ErrorCode::kIo, "full");
    return {};
  }
  Status finish() override {
    ++finished;
    return {};
  }
  std::vector<std::uint64_t> steps, hashes;
  int readings = 0, finished = 0;

 private:
  StreamId stream_;
  std::uint64_t fails_at_;
};

// Notes the times at which it is polled; fails at one of them.
class Device final : public SampleSource {
 public:
  explicit Device(std::size_t fails_at = SIZE_MAX) : fails_at_(fails_at) {}
  Status poll(SampleInbox&, double scene_time_s) override {
    times_s.push_back(scene_time_s);
    if (times_s.size() == fails_at_) return failure(ErrorCode::kIo, "unplugged");
    return {};
  }
  std::vector<double> times_s;

 private:
  std::size_t fails_at_;
};

TEST_F(LoopTest, ASourceIsPolledBeforeEachStepAndItsFailureEndsTheRun) {
  const auto dive = physics();
  const double step_s = dive->world().step_s();
  Listener listener(dive->world());
  Device first, second(5);
  Loop loop({.clock = Clock::simulated(0.0, step_s),
             .physics = dive.get(),
             .sources = {&first, &second},
             .step_sinks = {&listener},
             .stop = {.frames = 240}});
  const Status status = loop.run();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "unplugged");
  EXPECT_EQ(listener.finished, 1);
  EXPECT_EQ(dive->newest().step, 4u);
  EXPECT_EQ(loop.frames(), 4u);
  ASSERT_EQ(first.times_s.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_DOUBLE_EQ(first.times_s[i], static_cast<double>(i) * step_s);
}

TEST_F(LoopTest, ASinkSeesEachStepOnceInOrderFromTheStartOn) {
  const auto dive = physics();
  Listener listener(dive->world());
  Loop loop({.clock = Clock::simulated(0.0, dive->world().step_s()),
             .physics = dive.get(),
             .step_sinks = {&listener},
             .stop = {.frames = 240}});
  ASSERT_TRUE(loop.run().ok());
  EXPECT_EQ(loop.frames(), 240u);
  ASSERT_EQ(listener.steps.size(), 241u);
  for (std::uint64_t i = 0; i < listener.steps.size(); ++i) EXPECT_EQ(listener.steps[i], i);
  EXPECT_EQ(listener.hashes.back(), dive->newest().hash);
  EXPECT_EQ(listener.finished, 1);
  // One second of the sensor's rate.
  const double rate_hz = dive->world().vehicles()[0].file.sensors.pressure->rate_hz;
  EXPECT_NEAR(listener.readings, rate_hz, 1.0);
}

TEST_F(LoopTest, AThreadGivesItsSinksTheSameStatesAsLockStep) {
  const auto live = physics(LivePhysics::Pace::kClock), offline = physics();
  Listener heard(live->world()), expected(offline->world());
  live->observe([&](const auto& step) { ASSERT_TRUE(heard.accept(step, {}).ok()); });
  live->start();
  for (int look = 0; look < 500 && live->shown_snapshot().step < 24; ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    live->follow(now_ns(), 0.0);
  }
  live->stop();
  Loop loop({.clock = Clock::simulated(0.0, offline->world().step_s()),
             .physics = offline.get(),
             .step_sinks = {&expected},
             .stop = {.frames = live->newest().step}});
  ASSERT_TRUE(loop.run().ok());
  ASSERT_GT(heard.steps.size(), 5u);
  EXPECT_EQ(heard.steps, expected.steps);
  EXPECT_EQ(heard.hashes, expected.hashes);
}

TEST_F(LoopTest, AFailedSinkEndsTheRunAndAllAreFinished) {
  const auto dive = physics();
  Listener other(dive->world()), failing(dive->world(), 10);
  Loop loop({.clock = Clock::simulated(0.0, dive->world().step_s()),
             .physics = dive.get(),
             .step_sinks = {&other, &failing}});
  const Status status = loop.run();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "full");
  EXPECT_EQ(dive->newest().step, 10u);
  EXPECT_EQ(other.finished + failing.finished, 2);
}

// At the host's pace a step is due by the host's clock, which devices stamp by.
TEST_F(LoopTest, StepsAtTheHostsPaceAndTheirReadingsHaveItsTimes) {
  const auto dive = physics();
  class Stamps final : public StepSink {
   public:
    explicit Stamps(StreamId stream) : stream_(stream) {}
    std::vector<StreamId> streams() const override { return {stream_}; }
    Status accept(const sim::Snapshot<PhysicsState>& step,
                  std::span<const Sample> outputs) override {
      if (step.step == 0) return {};
      EXPECT_LE(step.host_ns, now_ns());
      if (!due_ns.empty()) {
        EXPECT_GT(step.host_ns, due_ns.back());
      }
      due_ns.push_back(step.host_ns);
      for (const Sample& sample : outputs) {
        EXPECT_LE(sample.header.captured_ns, step.host_ns);
        EXPECT_GT(sample.header.captured_ns, step.host_ns - 1'000'000'000);
      }
      return {};
    }
    Status finish() override { return {}; }
    std::vector<TimeNs> due_ns;

   private:
    StreamId stream_;
  } stamps(dive->world().streams().find("rov/pressure").value());
  const double step_s = dive->world().step_s();
  const TimeNs begun_ns = now_ns();
  Loop loop({.clock = Clock::real(0.0, step_s),
             .physics = dive.get(),
             .step_sinks = {&stamps},
             .stop = {.frames = 60}});
  ASSERT_TRUE(loop.run().ok());
  ASSERT_EQ(stamps.due_ns.size(), 60u);
  EXPECT_GE(stamps.due_ns.front(), begun_ns);
}

TEST_F(LoopTest, AnInterruptEndsItBetweenSteps) {
  const auto dive = physics();
  Loop loop({.clock = Clock::simulated(0.0, dive->world().step_s()),
             .physics = dive.get(),
             .stop = {.interrupted = [&] { return dive->newest().step >= 7; }}});
  ASSERT_TRUE(loop.run().ok());
  EXPECT_TRUE(loop.interrupted());
  EXPECT_EQ(dive->newest().step, 7u);
}

// The physics, its sinks and sources may have other owners than the loop.
TEST_F(LoopTest, AfterARunThePhysicsCallsNoSinkAndNoSourceOfIt) {
  const auto dive = physics();
  Listener listener(dive->world());
  Device device;
  const auto run = [&](std::vector<StepSink*> sinks, std::vector<SampleSource*> sources) {
    Loop loop({.clock = Clock::simulated(0.0, dive->world().step_s()),
               .physics = dive.get(),
               .sources = std::move(sources),
               .step_sinks = std::move(sinks),
               .stop = {.frames = 5}});
    return loop.run();
  };
  ASSERT_TRUE(run({&listener}, {&device}).ok());
  dive->advance();
  ASSERT_TRUE(run({}, {}).ok());
  EXPECT_EQ(dive->newest().step, 11u);
  EXPECT_EQ(listener.steps.size(), 6u);
  EXPECT_EQ(device.times_s.size(), 5u);
}

TEST(LoopClock, SimulatedFramesAreMultiplesOfThePeriodFromTheStart) {
  Clock clock = Clock::simulated(100.0, 0.25);
  for (int i = 0; i < 8; ++i) {
    const FrameTime at = clock.next(std::nullopt);
    EXPECT_EQ(at.time_s, 100.0 + 0.25 * i);
    EXPECT_EQ(at.next_time_s, 100.25 + 0.25 * i);
  }
  EXPECT_EQ(clock.dropped(), 0u);
}

TEST(LoopClock, ARealClockFollowsTheDisplayOrWaitsAndDropsWhatIsTooLate) {
  Clock shown = Clock::real(5.0, 0.1);
  EXPECT_EQ(shown.next(1'000'000'000).time_s, 5.0);
  EXPECT_DOUBLE_EQ(shown.next(1'250'000'000).time_s, 5.25);
  const TimeNs begun_ns = now_ns();
  Clock waiting = Clock::real(0.0, 0.01);
  for (int i = 0; i < 5; ++i) waiting.next(std::nullopt);
  EXPECT_GE(now_ns() - begun_ns, 50'000'000);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  // 30 steps are late. The 10 of the last 100 ms are caught up; the others are dropped.
  for (int i = 0; i < 10; ++i) waiting.next(std::nullopt);
  EXPECT_GE(waiting.dropped(), 20u);
}

// A display says when its pictures are seen; the scene's time is the run's, which never falls.
// Its frames go on by the host's time after a second, and by the display's once that is ahead
// again.
TEST(LoopClock, ADisplayWhoseTimeStandsDoesNotHoldTheFrames) {
  sim::HostClock host;
  Clock clock = Clock::real(5.0, 0.1);
  const TimeNs begun_ns = host.now(), stands_ns = 1'000'000'000;
  double last_s = clock.next(stands_ns).time_s;
  EXPECT_EQ(last_s, 5.0);
  while (host.now() < begun_ns + 1'500'000'000) {
    const TimeNs passed_ns = host.now() - begun_ns;
    const double time_s = clock.next(stands_ns).time_s;
    if (passed_ns < 900'000'000) EXPECT_EQ(time_s, 5.0);
    EXPECT_GE(time_s, last_s);
    last_s = time_s;
    host.wait_until(host.now() + 20'000'000);
  }
  EXPECT_GT(last_s, 5.3);
  EXPECT_LT(last_s, 5.6);
  EXPECT_DOUBLE_EQ(clock.next(stands_ns + 700'000'000).time_s, 5.7);
  EXPECT_DOUBLE_EQ(clock.next(stands_ns + 800'000'000).time_s, 5.8);
}

TEST(LoopClock, FramesOfAClockThatAPersonStopsStandAndGoOn) {
  sim::SimulatedClock host;
  sim::RunClock run(host);
  Clock clock = Clock::real(5.0, 0.1, Clock::Frames::kPictures, &run);
  const auto frame_after = [&](TimeNs host_ns) {
    host.advance(host_ns);
    return clock.next(host.now() + 16'000'000).time_s;  // seen a little later
  };
  EXPECT_EQ(frame_after(0), 5.0);
  EXPECT_DOUBLE_EQ(frame_after(250'000'000), 5.25);
  run.pause(true);
  EXPECT_DOUBLE_EQ(frame_after(0), 5.25);
  EXPECT_DOUBLE_EQ(frame_after(9'000'000'000), 5.25);
  run.step(100'000'000);
  EXPECT_NEAR(frame_after(1'000'000'000), 5.35, 0.017);
  run.pause(false);
  run.set_speed(0.5);
  EXPECT_NEAR(frame_after(2'000'000'000), 6.35, 0.017);
}

// Frames of a run without a screen that take longer than their period: none is caught up, and the
// scene's time keeps up with the host's.
TEST(LoopClock, TimeRunsOnOverDroppedFrames) {
  Clock clock = Clock::real(2.0, 0.01, Clock::Frames::kPictures);
  const FrameTime first = clock.next(std::nullopt);
  for (int i = 0; i < 4; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(35));
    const FrameTime at = clock.next(std::nullopt);
    EXPECT_NEAR(at.time_s - first.time_s, 1e-9 * static_cast<double>(at.run_ns - first.run_ns),
                0.0101);
  }
  EXPECT_GE(clock.dropped(), 8u);
}

}  // namespace
}  // namespace neritic::testbed
