// A track is where its keys say, straight in between, still outside; its velocities are the slopes
// of its poses; a lawn mower leaves no strip wider than its spacing.
#include "engine/scene/track.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {

void PrintTo(const LawnMower& mower, std::ostream* out) {
  *out << fmt::format("{:g} x {:g} m, legs {:g} m apart", mower.x1_m - mower.x0_m,
                      mower.z1_m - mower.z0_m, mower.spacing_m);
}

namespace {

Vec3 forward(const Pose& pose) {
  return pose.rotation * Vec3(0, 0, -1);
}

// 10 m north, then 5 m east, at 2 m/s from second 3 on.
Track corner(const TrackHeading& heading = {}) {
  return track_of(places_of({{{0, -5, 0}, {0, -5, -10}, {5, -5, -10}}, 2.0, 3.0}), heading);
}

TEST(Track, PositionsRunStraightAndStandStillOutside) {
  const Track track = corner();
  expect_near(pose_at(track, -100).position_m, {0, -5, 0});
  expect_near(pose_at(track, 3).position_m, {0, -5, 0});
  expect_near(pose_at(track, 5.5).position_m, {0, -5, -5});
  expect_near(pose_at(track, 8).position_m, {0, -5, -10});
  expect_near(pose_at(track, 9).position_m, {2, -5, -10});
  expect_near(pose_at(track, 10.5).position_m, {5, -5, -10});
  expect_near(pose_at(track, 1e9).position_m, {5, -5, -10});
  expect_near(velocity_at(track, 2.999), {0, 0, 0});
  expect_near(velocity_at(track, 4), {0, 0, -2});
  expect_near(velocity_at(track, 8), {2, 0, 0});
  expect_near(velocity_at(track, 10.5), {0, 0, 0});
}

TEST(Track, HeadingFollowsTheCourseAndTurnsWithinTheStatedLength) {
  const Track track = corner({.turn_m = 2.0});
  expect_near(forward(pose_at(track, 0)), {0, 0, -1});
  expect_near(forward(pose_at(track, 7.49)), {0, 0, -1});
  expect_near(forward(pose_at(track, 8)), {std::sqrt(0.5), 0, -std::sqrt(0.5)});
  expect_near(forward(pose_at(track, 8.5)), {1, 0, 0});
  expect_near(forward(pose_at(track, 99)), {1, 0, 0});
  // To starboard by 90 degrees in 2 m at 2 m/s.
  expect_near(angular_velocity_at(track, 8.2), {0, -kPi / 2, 0});
  expect_near(angular_velocity_at(track, 7), {0, 0, 0});
}

TEST(Track, WithoutATurningLengthItTurnsAtOnce) {
  const Track track = corner({.turn_m = 0.0});
  expect_near(forward(pose_at(track, 7.999999)), {0, 0, -1});
  expect_near(forward(pose_at(track, 8)), {1, 0, 0});
  expect_near(angular_velocity_at(track, 8), {0, 0, 0});
}

// A square of 8 m, a metre a second, from second 2 on: round after round the same places, ahead
// along each leg, and nothing jumps where a round begins.
TEST(Track, ACourseThatRepeatsGoesRoundWithoutAJump) {
  const Waypoints square{{{0, 0, 0}, {8, 0, 0}, {8, 0, 8}, {0, 0, 8}}, 1.0, 2.0, true};
  Track track = track_of(places_of(square), {.turn_m = 2.0});
  close(track);
  expect_near(pose_at(track, 0.0).position_m, {0, 0, 0});
  expect_near(velocity_at(track, 0.0), {0, 0, 0});
  for (const double round_s : {0.0, 32.0, 32.0 * 1000}) {
    expect_near(pose_at(track, round_s + 6).position_m, {4, 0, 0});
    expect_near(forward(pose_at(track, round_s + 6)), {1, 0, 0});
    expect_near(pose_at(track, round_s + 30).position_m, {0, 0, 4});
    expect_near(forward(pose_at(track, round_s + 30)), {0, 0, -1});
    expect_near(velocity_at(track, round_s + 30), {0, 0, -1});
  }
  // In the middle of the turn at the round's end.
  expect_near(forward(pose_at(track, 34)), {std::sqrt(0.5), 0, -std::sqrt(0.5)});
  for (double t = 2.0; t < 80.0; t += 0.05) {
    const Pose a = pose_at(track, t), b = pose_at(track, t + 0.05);
    EXPECT_LT(glm::distance(a.position_m, b.position_m), 0.0501) << t;
    EXPECT_LT(glm::distance(forward(a), forward(b)), 0.08) << t;
  }
}

TEST(Track, ATurnTakesNoMoreThanHalfALeg) {
  const Track track = corner({.turn_m = 1000.0});
  expect_near(forward(pose_at(track, 5.5)), {0, 0, -1});  // the middle of the first leg
  expect_near(forward(pose_at(track, 9.25)), {1, 0, 0});  // and of the second
  EXPECT_LT(forward(pose_at(track, 5.6)).z, 0.0);
  EXPECT_GT(forward(pose_at(track, 5.6)).x, 0.0);
}

TEST(Track, OwnRotationComesOnTopOfTheHeadingOrStandsAlone) {
  const Quat down = from_yaw_pitch_roll(0, radians(-30), 0);
  expect_near(forward(pose_at(corner({.rotation = down}), 10)), {std::sqrt(0.75), -0.5, 0});
  const Track fixed = corner({.along = false, .rotation = down});
  for (const double t : {-1.0, 5.0, 8.0, 10.0, 20.0})
    expect_near(forward(pose_at(fixed, t)), {0, -0.5, -std::sqrt(0.75)});
}

TEST(Track, AVerticalLegKeepsTheHeadingBeforeIt) {
  const Track dive = track_of(places_of({{{0, 0, 0}, {4, 0, 0}, {4, -8, 0}, {0, -8, 0}}, 1.0, 0.0}),
                              {.turn_m = 0.0});
  expect_near(forward(pose_at(dive, 8)), {1, 0, 0});
  expect_near(forward(pose_at(dive, 13)), {-1, 0, 0});
  // At the start, that of the first leg that has one; none at all: as it stands.
  const Track descent_first =
      track_of(places_of({{{0, 0, 0}, {0, -3, 0}, {3, -3, 0}}, 1.0, 0.0}), {});
  expect_near(forward(pose_at(descent_first, 1)), {1, 0, 0});
  const Track elevator = track_of(places_of({{{0, 0, 0}, {0, -3, 0}}, 1.0, 0.0}), {});
  expect_near(forward(pose_at(elevator, 1)), {0, 0, -1});
}

TEST(Track, VelocitiesAreTheSlopesOfPoses) {
  Track track;
  track.places = {{-2, {1, 2, 3}}, {0.5, {4, -1, 0}}, {3, {4, -1, 7}}};
  track.attitudes = {{-2, from_yaw_pitch_roll(3.0, 0.2, 0.1)},
                     {1, -from_yaw_pitch_roll(-3.0, -0.4, 0.3)},
                     {3, from_yaw_pitch_roll(-2.0, 0.1, -0.2)}};
  constexpr double kStep_s = 1e-6;
  for (const double t : {-1.9, -0.3, 0.6, 0.99, 1.5, 2.8}) {
    const Pose a = pose_at(track, t - kStep_s), b = pose_at(track, t + kStep_s);
    expect_near(velocity_at(track, t), (b.position_m - a.position_m) / (2 * kStep_s), 1e-6);
    Quat turn = b.rotation * glm::conjugate(a.rotation);
    if (turn.w < 0) turn = -turn;
    expect_near(angular_velocity_at(track, t), Vec3(turn.x, turn.y, turn.z) / kStep_s, 1e-6);
    EXPECT_NEAR(glm::length(pose_at(track, t).rotation), 1.0, 1e-12);
  }
  // The short way round from yaw 3 to -3: 0.28 rad and a little pitch and roll, not 6 rad.
  EXPECT_LT(glm::length(angular_velocity_at(track, 0)), 0.4);
}

TEST(Track, FarFromTheOriginItRunsAsSmoothly) {
  const Track track = track_of(places_of({{{1e5, 0, 1e5}, {1e5 + 100, 0, 1e5}}, 0.5, 0.0}), {});
  for (int i = 1; i < 200; ++i)
    EXPECT_NEAR(pose_at(track, i).position_m.x - pose_at(track, i - 1).position_m.x, 0.5, 1e-9);
}

class LawnMowerTest : public testing::TestWithParam<LawnMower> {};

TEST_P(LawnMowerTest, CoversItsAreaWithLegsASpacingApart) {
  const LawnMower& mower = GetParam();
  const std::vector<Vec3> points = waypoints_of(mower);
  ASSERT_EQ(points.size(), 2 * leg_count(mower));
  expect_near(points[0], {mower.x0_m, -mower.depth_m, mower.z0_m});
  std::vector<double> across;
  for (std::size_t i = 0; i < points.size(); i += 2) {
    const Vec3 a = points[i], b = points[i + 1];
    const double from = mower.along_x ? mower.x0_m : mower.z0_m,
                 to = mower.along_x ? mower.x1_m : mower.z1_m;
    const auto along = [&](const Vec3& p) { return mower.along_x ? p.x : p.z; };
    EXPECT_EQ(along(a), i % 4 == 0 ? from : to);
    EXPECT_EQ(along(b), i % 4 == 0 ? to : from);
    across.push_back(mower.along_x ? a.z : a.x);
    EXPECT_EQ(across.back(), mower.along_x ? b.z : b.x);
    EXPECT_EQ(a.y, -mower.depth_m);
  }
  for (std::size_t i = 1; i < across.size(); ++i)
    EXPECT_NEAR(across[i] - across[i - 1], mower.spacing_m, 1e-9);
  const double edge = mower.along_x ? mower.z1_m : mower.x1_m;
  EXPECT_LE(across.back(), edge + 1e-9);
  EXPECT_LT(edge - across.back(), mower.spacing_m);
}

INSTANTIATE_TEST_SUITE_P(Areas, LawnMowerTest,
                         testing::Values(LawnMower{-50, -30, 50, 30, 12, 10, true},
                                         LawnMower{0, 0, 10, 40, 2, 3, false},
                                         LawnMower{0, 0, 0.3, 1, 2, 0.1, false},
                                         LawnMower{0, 0, 1, 1, -1, 5, true}),
                         [](const auto& info) {
                           return test::test_name(info.index, testing::PrintToString(info.param));
                         });

}  // namespace
}  // namespace neritic::scene
