// Objects that devices move: where the one source of motion has them, and how they move.
#include "testbed/motion/live_physics.hpp"
#include "tests/testbed/simulation/capture.hpp"

namespace neritic::testbed {
namespace {

TEST(ObjectPoseMotion, ATrackedPropIsWhereItWasMeasuredAtEachTimeAndMovesSo) {
  const auto scene = load_text(prop_text("inputs = { pose = \"mocap\" }\n")).value();
  auto live = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
  Capture capture(live->inbox(), live->world().streams());
  const scene::MotionSource source(scene, &live->motion());
  constexpr double kLatency_s = 0.02;
  double worst_m = 0.0, worst_m_s = 0.0, worst_rad = 0.0;
  // 120 Hz beside 240 steps a second, 20 ms late.
  for (int i = 0; i < 480; ++i) {
    const double now_s = i / 120.0;
    live->follow(0, now_s - 1e-6);  // to the state of now_s, not one more by rounding
    capture.see(now_s - kLatency_s,
                at(circling(now_s - kLatency_s).pose.position_m,
                   circling(now_s - kLatency_s).pose.rotation),
                kLatency_s);
    if (i < 3) continue;
    const double t = now_s - 0.3 / 240.0;
    const scene::MotionAt seen = source.at({.object = 0}, t);
    EXPECT_EQ(seen.known, scene::Knowledge::kBetween);
    const Motion truth = circling(t);
    worst_m = std::max(worst_m, glm::distance(seen.motion.pose.position_m, truth.pose.position_m));
    worst_m_s = std::max(worst_m_s, glm::distance(seen.motion.velocity_m_s, truth.velocity_m_s));
    const Quat turn = seen.motion.pose.rotation * glm::conjugate(truth.pose.rotation);
    worst_rad = std::max(worst_rad, 2.0 * glm::length(Vec3(turn.x, turn.y, turn.z)));
    EXPECT_LT(glm::distance(seen.motion.angular_velocity_rad_s, truth.angular_velocity_rad_s),
              1e-6);
  }
  // Its acceleration over the latency and an interval: 4.9 m/s^2 * (0.03 s)^2 / 2, and * 0.035 s.
  EXPECT_LT(worst_m, 0.004);
  EXPECT_LT(worst_m_s, 0.2);
  EXPECT_LT(worst_rad, 1e-6);
}

TEST(ObjectPoseMotion, UnderTheAutopilotItsTrackHasIt) {
  const std::string track = "track = { waypoints_m = [[0, -5, 0], [100, -5, 0]], speed_m_s = 1 }\n";
  const auto scene = load_text(prop_text("inputs = { pose = { from = \"mocap\", hold_s = "
                                         "0.2, then = \"autopilot\" } }\n",
                                         track))
                         .value();
  auto live = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
  Capture capture(live->inbox(), live->world().streams());
  const scene::MotionSource source(scene, &live->motion());
  const auto seen = [&](double t) {
    live->follow(0, t);
    return source.at({.object = 0}, t).motion;
  };
  EXPECT_NEAR(seen(1.0).velocity_m_s.x, 1.0, 1e-9);
  const double before_m = seen(1.1).pose.position_m.x;
  capture.see(1.1, at({7, -8, 9}));
  EXPECT_EQ(seen(1.2).pose.position_m, Vec3(7, -8, 9));
  EXPECT_NEAR(seen(1.5).pose.position_m.x, before_m + 0.4, 1e-6);
  EXPECT_NEAR(seen(1.5).velocity_m_s.x, 1.0, 1e-9);
}

}  // namespace
}  // namespace neritic::testbed
