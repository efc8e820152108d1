// Physics beside a picture: in lock-step it is where a simulation of that time is, on its thread
// where the clock says, between two steps and no farther than one from either.
#include "testbed/motion/live_physics.hpp"

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

#include "engine/sim/run_clock.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

scene::Scene drifting_scene() {
  return load_text("[physics]\n[current]\nkind = \"uniform\"\nvelocity_m_s = [0.5, 0, 0]\n" +
                   rov_text("position_m = [0, -10, 0]\n"))
      .value();
}

TEST(LivePhysics, InLockStepItIsThePathFlown) {
  scene::Scene scene = drifting_scene();
  TestDive dive = dive_of(scene);
  const auto live = LivePhysics::create(scene, LivePhysics::Pace::kPicture);
  ASSERT_TRUE(live.ok());
  (*live)->start();
  for (int frame = 0; frame < 30; ++frame) {
    EXPECT_EQ((*live)->follow(0, frame / 30.0), frame / 30.0);
    EXPECT_LT(glm::distance((*live)->pose(0).position_m, dive.pose().position_m), 1e-9);
    dive.run(1.0 / 30.0);
  }
  EXPECT_EQ((*live)->newest().hash, dive.simulation->log().hashes[(*live)->newest().step]);
}

TEST(LivePhysics, OnItsThreadItKeepsTheClocksPace) {
  scene::Scene scene = drifting_scene();
  TestDive dive = dive_of(scene);
  dive.run(3.0);
  std::vector<Vec3> path{Vec3(0, -10, 0)};
  TestDive again = dive_of(scene);
  again.run(3.0, [&] { path.push_back(again.pose().position_m); });
  const auto live = LivePhysics::create(scene, LivePhysics::Pace::kClock);
  ASSERT_TRUE(live.ok());
  (*live)->start();
  const TimeNs begun_ns = now_ns();
  double farthest_m = 0.0;
  for (TimeNs now = begun_ns; now < begun_ns + 1'000'000'000; now = now_ns()) {
    (*live)->follow(now, 0.0);
    const Vec3 at = (*live)->pose(0).position_m;
    double nearest_m = 1e9;
    for (const Vec3& p : path) nearest_m = std::min(nearest_m, glm::distance(p, at));
    farthest_m = std::max(farthest_m, nearest_m);
  }
  EXPECT_LT(farthest_m, 5e-3);
  // A machine that holds the thread up at the end of the second is looked at again.
  const auto steps_a_second = [&] {
    const auto counts = (*live)->counts();
    return static_cast<double>(counts.steps + counts.dropped) * 1e9 /
           static_cast<double>(now_ns() - begun_ns);
  };
  for (int look = 0; look < 200 && (steps_a_second() < 235.0 || steps_a_second() > 260.0); ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    (*live)->follow(now_ns(), 0.0);
  }
  EXPECT_GT(steps_a_second(), 235.0);
  EXPECT_LT(steps_a_second(), 260.0);
}

// A person stops the run's time: steps and picture stand; and speeds it up: more steps, by as much.
TEST(LivePhysics, OnAClockThatAPersonStopsItStandsAndGoesOn) {
  sim::HostClock host;
  sim::RunClock clock(host);
  auto world = PhysicsWorld::create(drifting_scene()).value();
  const auto live =
      LivePhysics::create(std::move(world), {.pace = LivePhysics::Pace::kClock, .clock = &clock});
  live->start();
  const auto follow_for = [&](TimeNs host_ns) {
    double shown_s = 0.0;
    for (const TimeNs end_ns = now_ns() + host_ns; now_ns() < end_ns;)
      shown_s = live->follow(clock.now(), 0.0);
    return shown_s;
  };
  follow_for(100'000'000);
  clock.pause(true);
  // Steps that a busy machine has to catch up come first.
  double before_s = -1.0, stood_s = follow_for(50'000'000);
  for (int look = 0; look < 100 && (stood_s != before_s || stood_s == 0.0); ++look)
    before_s = std::exchange(stood_s, follow_for(50'000'000));
  EXPECT_GT(stood_s, 0.0);
  EXPECT_NEAR(follow_for(100'000'000), stood_s, 1e-9);
  // A machine that held the thread up before the pause leaves steps to catch up first.
  double stepped_s = stood_s;
  int steps = 0;
  while (steps < 20 && stepped_s <= stood_s) {
    clock.step(50'000'000);
    ++steps;
    stepped_s = follow_for(200'000'000);
  }
  EXPECT_GT(stepped_s, stood_s);
  EXPECT_LT(stepped_s, stood_s + 0.051 * steps);
  clock.set_speed(4.0);
  clock.pause(false);
  const auto due = [&] {
    const auto counts = live->counts();
    return static_cast<double>(counts.steps + counts.dropped);
  };
  // At the host's pace 0.4 s would take twice as long.
  const TimeNs fast_ns = now_ns();
  while (due() < 240.0 * (stepped_s + 0.4) && now_ns() < fast_ns + 10'000'000'000)
    follow_for(20'000'000);
  const double pace =
      (due() / 240.0 - stepped_s) / (1e-9 * static_cast<double>(now_ns() - fast_ns));
  EXPECT_GT(due(), 240.0 * (stepped_s + 0.4));
  EXPECT_GT(pace, 1.5);
}

// A command that came just before a picture begins is in the state that it shows; the steps are
// those of the clock, one after another, none more.
TEST(LivePhysics, AHastenedPictureShowsWhatJustCame) {
  auto world = PhysicsWorld::create(drifting_scene()).value();
  const auto live = LivePhysics::create(std::move(world), {.pace = LivePhysics::Pace::kClock});
  live->hasten_steps(true);
  const SourceId python = live->inbox().open("python").value();
  const auto stream = live->world().streams().find("rov/wrench").value();
  std::atomic<std::uint64_t> used{0}, step{0}, used_by{0};
  std::vector<std::uint64_t> steps;
  live->observe(
      [&](const auto& snapshot) {
        step = snapshot.step;
        steps.push_back(snapshot.step);
      },
      [&](const Sample& sample) {
        if (sample.header.source != python) return;
        used = sample.header.sequence;
        used_by = step + 1;
      });
  live->start();
  const TimeNs begun_ns = now_ns();
  int shown = 0;
  VehicleWrench push_ahead;
  push_ahead.wrench[0] = 10.0;
  constexpr int kPictures = 200;
  for (std::uint64_t i = 1; i <= kPictures; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(7300));  // at any time of a step
    const TimeNs now = now_ns();
    ASSERT_EQ(live->inbox().push({{stream, python, i, now, now}, push_ahead}),
              SampleVerdict::kAccepted);
    live->follow(now_ns(), 0.0);
    shown += used == i && used_by <= live->shown_snapshot().step;
  }
  live->stop();
  // The others came while a step ran on the thread.
  EXPECT_GT(shown, kPictures * 8 / 10);
  const auto counts = live->counts();
  const double steps_s = static_cast<double>(counts.steps + counts.dropped) / 240.0;
  EXPECT_NEAR(steps_s, 1e-9 * static_cast<double>(now_ns() - begun_ns), 2.0 / 240.0 + 0.01);
  EXPECT_EQ(steps.size(), counts.steps + 1);
  for (std::size_t i = 0; i < steps.size(); ++i) ASSERT_EQ(steps[i], i);
}

}  // namespace
}  // namespace neritic::testbed
