// Guidance blocks flown: where the vehicle ends up, how fast it goes, where it faces. And the axes
// in which the rest of the program sees it.
#include "rov/guidance.hpp"

#include <gtest/gtest.h>

#include "rov/closed_loop.hpp"
#include "rov/frames.hpp"
#include "tests/rov/random_vehicle.hpp"

namespace neritic::rov {
namespace {

State resting(const Vec3& position = {0, 0, 10}) {
  State state;
  state.position_ned_m = position;
  return state;
}

std::vector<State> flown(const Guide& guide, double seconds, const State& start = resting()) {
  return fly(heavy_vehicle(), default_gains(), start, guide, seconds).states;
}

TEST(RovGuidance, GoToHoldsItsSpeedAndLineAndStopsAtTheEnd) {
  const Vec3 from(0, 0, 10), to(8, 4, 12);
  const auto states =
      flown([&](const State& s, double) { return go_to(Setpoint{}, s, from, to, 0.4); }, 45.0);
  const Vec3 along = glm::normalize(to - from);
  for (std::size_t k = 250; k < 750; ++k) {  // from 5 to 15 s
    const Vec3 at = states[k].position_ned_m - from;
    EXPECT_LT(glm::length(at - glm::dot(at, along) * along), 0.03) << k;
    EXPECT_NEAR(glm::dot(states[k].attitude * states[k].velocity.linear(), along), 0.4, 0.03) << k;
  }
  double farthest = 0.0;
  for (const State& s : states)
    farthest = std::max(farthest, glm::dot(s.position_ned_m - from, along));
  EXPECT_LT(farthest, glm::distance(from, to) + 0.02);
  EXPECT_LT(glm::distance(states.back().position_ned_m, to), 0.01);
}

TEST(RovGuidance, OrbitKeepsItsRadiusAndLooksAtTheMiddle) {
  const Vec3 centre(3, 1, 12);
  const auto states =
      flown([&](const State& s,
                double) { return look_at(orbit(Setpoint{}, s, centre, 3.0, 0.4), centre); },
            90.0);
  double turned = 0.0;
  for (std::size_t k = 1000; k < states.size(); ++k) {  // after 20 s
    const Vec3 off = states[k].position_ned_m - centre,
               before = states[k - 1].position_ned_m - centre;
    EXPECT_NEAR(std::hypot(off.x, off.y), 3.0, 0.15);
    EXPECT_NEAR(off.z, 0.0, 0.02);
    turned += std::atan2(before.x * off.y - before.y * off.x, before.x * off.x + before.y * off.y);
    const Vec3 ahead = states[k].attitude * Vec3(1, 0, 0);
    EXPECT_GT(glm::dot(glm::normalize(-off), ahead), std::cos(radians(10.0))) << k;
  }
  EXPECT_NEAR(turned, 70.0 * 0.4 / 3.0, 0.8);  // from north to east
}

TEST(RovGuidance, FollowKeepsItsPlaceBesideWhatMoves) {
  const Vec3 velocity(0.3, 0.2, 0.0);
  const double heading = std::atan2(velocity.y, velocity.x);
  const auto target = [&](double t) { return Vec3(2, 2, 11) + t * velocity; };
  const auto states = flown(
      [&](const State&, double t) {
        return look_at(follow(Setpoint{}, target(t), velocity, heading, {-2.0, 1.0, -0.5}),
                       target(t));
      },
      40.0);
  const Vec3 expected = target(40.0) + heading_attitude(heading) * Vec3(-2.0, 1.0, -0.5);
  EXPECT_LT(glm::distance(states.back().position_ned_m, expected), 0.05);
  const Vec3 ahead = states.back().attitude * Vec3(1, 0, 0);
  const Vec3 to = target(40.0) - states.back().position_ned_m;
  EXPECT_NEAR(std::atan2(ahead.y, ahead.x), std::atan2(to.y, to.x), radians(2.0));
}

TEST(RovGuidance, StandsBetweenAThreatAndADiverFacingTheDiver) {
  const Vec3 shark(10, 0, 14), diver(2, 4, 12);
  const auto states = flown(
      [&](const State&, double) { return stand_between(Setpoint{}, shark, diver, 1.5); }, 30.0);
  const State& end = states.back();
  EXPECT_NEAR(glm::distance(end.position_ned_m, diver), 1.5, 0.02);
  EXPECT_NEAR(glm::distance(end.position_ned_m, diver) + glm::distance(end.position_ned_m, shark),
              glm::distance(shark, diver), 0.01);  // on the line
  const Vec3 ahead = end.attitude * Vec3(1, 0, 0), to = diver - end.position_ned_m;
  EXPECT_NEAR(std::atan2(ahead.y, ahead.x), std::atan2(to.y, to.x), radians(1.0));
  const Setpoint middle = stand_between(Setpoint{}, shark, diver);
  EXPECT_LT(glm::distance(middle.position_ned_m, 0.5 * (shark + diver)), 1e-12);
}

TEST(RovGuidance, LookAtTiltsWhereAsked) {
  Setpoint s = go_to(Setpoint{}, {0, 0, 10});
  const Vec3 point(3, 0, 13);
  s = look_at(s, point, true);
  EXPECT_LT(glm::distance(s.attitude * Vec3(1, 0, 0), glm::normalize(point - s.position_ned_m)),
            1e-12);
  const auto off = [&](bool feed_forward) {
    ControlGains gains = default_gains();
    gains.feed_forward = feed_forward;
    const LoopRun run = fly(
        heavy_vehicle(), gains, resting(), [&](const State&, double) { return s; }, 15.0);
    return glm::distance(run.states.back().attitude * Vec3(1, 0, 0),
                         glm::normalize(point - s.position_ned_m));
  };
  EXPECT_LT(off(true), 3e-3);
  EXPECT_LT(off(false), 0.06);  // the integral's limit is below the righting moment
}

TEST(RovGuidance, WaypointsAreAcceptedInOrderWithinTheRadius) {
  WaypointFollower follower({{{1, 0, 10}, 0.0}, {{1, 1, 10.5}, kPi / 2}}, 0.2);
  std::vector<double> reached_s;
  const auto states = flown(
      [&](const State& s, double t) {
        const std::size_t before = follower.reached();
        const Setpoint to = follower.update(s);
        if (follower.reached() > before) reached_s.push_back(t);
        return to;
      },
      20.0);
  EXPECT_TRUE(follower.done());
  ASSERT_EQ(reached_s.size(), 2u);
  EXPECT_LT(reached_s[0], reached_s[1]);
  EXPECT_LT(glm::distance(states.back().position_ned_m, Vec3(1, 1, 10.5)), 0.01);
  EXPECT_NEAR(heading_of(states.back().attitude), kPi / 2, 0.01);
  WaypointFollower nowhere({});
  EXPECT_EQ(nowhere.update(states.back()).position_ned_m, states.back().position_ned_m);
}

TEST(RovGuidance, DepthHoldLeavesThePilotTheRest) {
  const State start = resting();
  const Setpoint hold = depth_hold(start, {{20, 0, 0, 0, 0, 1.0}});
  const auto states = flown([&](const State&, double) { return hold; }, 20.0);
  EXPECT_NEAR(states.back().position_ned_m.z, 10.0, 0.01);
  EXPECT_GT(states.back().velocity[0], 0.2);                           // 20 N of surge, not damped
  EXPECT_NEAR(states.back().velocity[5], std::sqrt(1.0 / 1.5), 0.05);  // 1.5 r^2 = 1 N m
}

TEST(RovGuidance, HeadingHoldKeepsItsHeadingInACurrent) {
  State start = resting();
  start.attitude = heading_attitude(0.5);
  const Vehicle vehicle = heavy_vehicle();
  const Allocator allocator(vehicle);
  const Setpoint hold = heading_hold(start, {});
  ControlState control;
  State state = start;
  for (int k = 0; k < 1500; ++k) {
    Inputs inputs = control_inputs(vehicle, allocator, default_gains(), hold, state, control);
    inputs.current_ned_m_s = {0.4, -0.2, 0.0};
    for (int i = 0; i < 5; ++i) state = step(vehicle, state, inputs, 0.004);
  }
  EXPECT_NEAR(heading_of(state.attitude), 0.5, 0.01);
  EXPECT_NEAR((state.attitude * state.velocity.linear()).x, 0.4, 0.02);  // drifts with the water
}

TEST(RovFrames, MarineAxesAndTheProgramsDescribeTheSameThing) {
  EXPECT_EQ(world_from_ned(Vec3(1, 0, 0)), Vec3(0, 0, -1));  // north is -z
  EXPECT_EQ(world_from_ned(Vec3(0, 1, 0)), Vec3(1, 0, 0));   // east is x
  EXPECT_EQ(world_from_ned(Vec3(0, 0, 1)), Vec3(0, -1, 0));  // down is -y
  for (std::uint64_t index = 0; index < 20; ++index) {
    Draws draws(index);
    const Quat q = draws.attitude();
    const Vec3 v = draws.vec3(3.0);
    EXPECT_EQ(ned_from_world(world_from_ned(v)), v);
    EXPECT_LT(glm::distance(world_from_ned(q) * world_from_ned(v), world_from_ned(q * v)), 1e-14);
    EXPECT_LT(glm::length(ned_from_world(world_from_ned(q)) - q), 1e-15);
    Vec6 d;
    for (double& x : d.v) x = draws.uniform(1.0, 3.0);
    const Mat6 m = coupled(draws, d, 0.3);
    const Vec6 marine = vec6(draws.vec3(1.0), draws.vec3(1.0));
    const Vec6 there = vec6(world_from_ned(marine.linear()), world_from_ned(marine.angular()));
    const Vec6 product = m * marine;
    const Vec6 expected = vec6(world_from_ned(product.linear()), world_from_ned(product.angular()));
    const Vec6 off = world_from_ned(m) * there - expected;
    EXPECT_LT(dot(off, off), 1e-26);
  }
  // A body that faces north, level, is the program's body that faces -z.
  EXPECT_EQ(world_pose(Vec3(0.0), Quat(1, 0, 0, 0)).rotation, Quat(1, 0, 0, 0));
  const Vec3 ahead = world_pose(Vec3(0.0), heading_attitude(kPi / 2)).rotation * Vec3(0, 0, -1);
  EXPECT_LT(glm::distance(ahead, Vec3(1, 0, 0)), 1e-12);  // east
}

}  // namespace
}  // namespace neritic::rov
