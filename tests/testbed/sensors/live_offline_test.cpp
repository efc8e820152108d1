// A sonar on a vehicle that swims by physics hears the same beside a running thread, as a window
// does, and in lock-step, as `render` does: the same bits wherever the states are the same, Doppler
// and motion within the ping included.
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "testbed/motion/live_physics.hpp"
#include "testbed/sensors/ping_schedule.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/wall_flight.hpp"

namespace neritic::testbed {
namespace {

SonarFrame ping_at(Session& session, double time_s, const scene::SimulatedMotion* simulated) {
  FrameRequest request;
  request.time_s = request.next_time_s = time_s;
  request.sonars = {0};
  request.simulated = simulated;
  auto result = session.render(request);
  EXPECT_TRUE(result.ok()) << result.error().message;
  return std::move(result->sonars[0]);
}

class LiveOffline : public test::GpuTest {};

TEST_F(LiveOffline, AThreadAndLockStepGiveTheSameSonarBits) {
  const scene::Scene scene = scene_of_flight();
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  NERITIC_ASSERT_OK(const auto live, LivePhysics::create(scene, LivePhysics::Pace::kClock));
  NERITIC_ASSERT_OK(const auto offline, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
  live->start();
  std::uint64_t last = 0;
  int pings_heard = 0;
  for (int ping = 0; ping < 8; ++ping) {
    do {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      live->follow(now_ns(), 0.0);
    } while (live->shown_snapshot().step <= last);
    last = live->shown_snapshot().step;
    const double time_s = (static_cast<double>(last) - 0.4) * live->world().step_s();
    const SonarFrame heard = ping_at(*session, time_s, &live->motion());
    offline->reach(time_s);
    ASSERT_EQ(offline->newest().step, last);
    EXPECT_EQ(live->shown_snapshot().hash, offline->newest().hash);
    const SonarFrame expected = ping_at(*session, time_s, &offline->motion());
    EXPECT_EQ(heard.image.intensity, expected.image.intensity) << time_s;
    EXPECT_EQ(heard.world_from_sonar.position_m, expected.world_from_sonar.position_m);
    pings_heard += std::ranges::any_of(heard.image.intensity, [](float i) { return i > 0.0f; });
  }
  EXPECT_GE(pings_heard, 1);  // later the vehicle has turned away from the wall
}

// A window on a simulated clock asks for each of its frames, and pings at those that are due;
// `render` asks for the pings alone, and already knows the states of the next one.
TEST_F(LiveOffline, AWindowsFramesAndRendersGiveTheSameSonarBits) {
  const scene::Scene scene = scene_of_flight();
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  NERITIC_ASSERT_OK(const auto window, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
  NERITIC_ASSERT_OK(const auto offline, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
  constexpr double kFrame_s = 1.0 / 64.0, kPing_s = 0.25;
  PingSchedule schedule({1.0 / kPing_s});
  window->start();
  std::uint32_t pings = 0;
  int pings_heard = 0;
  bool heard_last = false;
  for (int frame = 0; frame <= 256; ++frame) {
    FrameRequest shown;
    shown.time_s = shown.next_time_s = window->follow(0, frame * kFrame_s);
    const auto due = schedule.due(shown.time_s);
    if (due.empty()) continue;
    shown.sonars = {0};
    shown.pings = {due.front().number};
    shown.simulated = &window->motion();
    FrameRequest rendered;
    rendered.time_s = shown.time_s;
    rendered.next_time_s = shown.time_s + kPing_s;
    rendered.frame = pings++;
    rendered.sonars = {0};
    rendered.simulated = &offline->motion();
    offline->reach(rendered.time_s);
    EXPECT_EQ(window->newest().hash, offline->newest().hash) << shown.time_s;
    offline->reach(rendered.next_time_s);
    NERITIC_ASSERT_OK(const FrameResult heard, session->render(shown));
    NERITIC_ASSERT_OK(const FrameResult expected, session->render(rendered));
    const SonarFrame& a = heard.sonars.front();
    const SonarFrame& b = expected.sonars.front();
    EXPECT_EQ(a.image.intensity, b.image.intensity) << shown.time_s;
    EXPECT_EQ(a.world_from_sonar.position_m, b.world_from_sonar.position_m);
    heard_last = std::ranges::count_if(a.image.intensity, [](float i) { return i > 0.0f; }) > 0;
    pings_heard += heard_last;
  }
  EXPECT_EQ(pings, 17u);
  // While the vehicle looks away from the wall a ping is silent. The last is the one whose velocity
  // the next test shows to be heard.
  EXPECT_GE(pings_heard, 5);
  EXPECT_TRUE(heard_last);
}

// The change by the states' velocities, against the same place passed at the same velocity by a
// track.
TEST_F(LiveOffline, TheSonarHearsItsVehiclesVelocity) {
  const scene::Scene scene = scene_of_flight();
  NERITIC_ASSERT_OK(const auto physics, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
  constexpr double kTime_s = 4.0;
  physics->reach(kTime_s);
  const scene::MotionSource source(scene, &physics->motion());
  const Motion motion = source.at(scene.sonars[0].mount, kTime_s).motion;
  ASSERT_GT(glm::length(motion.velocity_m_s), 0.3);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  const SonarFrame heard = ping_at(*session, kTime_s, &physics->motion());
  const auto passing = [&](const Vec3& velocity_m_s, const Vec3& turn_rad_s) {
    scene::Scene by_track = scene;
    scene::Track track;
    for (const double t : {-1.0, 1.0}) {
      track.places.push_back({kTime_s + t, motion.pose.position_m + velocity_m_s * t});
      const double rate_rad_s = glm::length(turn_rad_s);
      const Quat turn = rate_rad_s == 0.0 ? Quat(1, 0, 0, 0)
                                          : glm::angleAxis(rate_rad_s * t, turn_rad_s / rate_rad_s);
      track.attitudes.push_back({kTime_s + t, glm::normalize(turn * motion.pose.rotation)});
    }
    by_track.sonars[0].mount = {-1, {}, track};
    // The vehicle's own box stays behind, out of sight.
    by_track.objects[1].mount.pose.position_m = {0.0, -10.0, 30.0};
    auto other = Session::create(device(), std::move(by_track));
    EXPECT_TRUE(other.ok());
    return ping_at(**other, kTime_s, nullptr);
  };
  const auto difference = [&](const SonarFrame& a) {
    double sum = 0.0, all = 0.0;
    for (std::size_t i = 0; i < a.image.intensity.size(); ++i) {
      sum += std::abs(double(a.image.intensity[i]) - double(heard.image.intensity[i]));
      all += heard.image.intensity[i];
    }
    return sum / all;
  };
  const double moving = difference(passing(motion.velocity_m_s, motion.angular_velocity_rad_s));
  const double still = difference(passing(Vec3(0.0), Vec3(0.0)));
  EXPECT_LT(moving, 1e-3);
  EXPECT_GT(still, 10.0 * moving);
  EXPECT_GT(still, 0.01);
}

}  // namespace
}  // namespace neritic::testbed
