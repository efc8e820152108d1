// Poses that a device measures, as motion: against the motion that they were measured of.
#include "testbed/samples/pose_track.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "engine/sim/fields.hpp"
#include "testbed/samples/capture_times.hpp"
#include "testbed/samples/group_inputs.hpp"
#include "tests/testbed/samples/streams.hpp"

namespace neritic::testbed {
namespace {

constexpr double kHold_s = 0.5;

TimeNs ns(double seconds) {
  return std::llround(1e9 * seconds);
}

ObjectPose at_x(double x_m) {
  return {.world_from_object = {.position_m = {x_m, 0.0, 0.0}}};
}

void take(PoseTrack& track, const ObjectPose& pose, double captured_s, double latency_s = 0.0) {
  track.take(pose, {.captured_ns = ns(captured_s), .arrived_ns = ns(captured_s + latency_s)},
             kHold_s);
}

TEST(PoseTrack, VelocitiesFollowFromPosesByTheirCaptureTimes) {
  const Vec3 velocity{1.0, -0.4, 0.25}, turn{0.3, 1.1, -0.5};
  PoseTrack track;
  // Irregular, and from a sender whose quaternions change sign.
  for (const double t : {0.0, 0.004, 0.011, 0.02, 0.037}) {
    const double angle = glm::length(turn) * t;
    const Quat rotation = glm::angleAxis(angle, turn / glm::length(turn));
    take(track, {.world_from_object = {velocity * t, t > 0.015 ? -rotation : rotation}}, t);
    if (t == 0.0) {
      EXPECT_EQ(track.at(0.05).pose.position_m, Vec3(0.0));
      continue;
    }
    const Motion now = track.at(0.0);
    EXPECT_LT(glm::distance(now.velocity_m_s, velocity), 1e-9);
    EXPECT_LT(glm::distance(now.angular_velocity_rad_s, turn), 1e-6);
    EXPECT_LT(glm::distance(track.at(0.03).pose.position_m, velocity * (t + 0.03)), 1e-9);
  }
}

// As doubles, nanoseconds since 1970 are 256 apart: 1.6e-5 of this interval.
TEST(PoseTrack, OfAClockThatCountsFrom1970IsAsExact) {
  constexpr TimeNs kStart_ns = 1'764'363'045'123'456'789, kEach_ns = 4'166'667;
  PoseTrack track;
  LimbTrack limbs;
  for (int i = 0; i < 5; ++i) {
    const TimeNs at_ns = kStart_ns + i * kEach_ns;
    const double t_s = 1e-9 * static_cast<double>(i * kEach_ns);
    const SampleHeader header{.captured_ns = at_ns, .arrived_ns = at_ns + 1'000'001};
    track.take(at_x(t_s), header, kHold_s);
    BodyJoints body{.joints = diver::straight_joints()};
    body.joints[3] = glm::angleAxis(2.0 * t_s, Vec3(0.0, 1.0, 0.0));
    limbs.take(body, header, kHold_s, 0);
    if (i == 0) continue;
    EXPECT_NEAR(track.newest.velocity_m_s.x, 1.0, 1e-9) << i;
    EXPECT_NEAR(limbs.rate_rad_s[3].y, 2.0, 1e-8) << i;
    EXPECT_NEAR(track.age_s, 1.000001e-3, 1e-12) << i;
    EXPECT_NEAR(limbs.age_s, 1.000001e-3, 1e-12) << i;
  }
  // Clocks whose difference no integer holds are far apart, and no more.
  EXPECT_GT(seconds_between(std::numeric_limits<TimeNs>::min(), 1), 9.2e9);
  EXPECT_LT(seconds_between(std::numeric_limits<TimeNs>::max(), -2), -9.2e9);
}

TEST(PoseTrack, LatencyIsMadeUpForByTheVelocity) {
  PoseTrack track;
  take(track, at_x(0.0), 10.0, 0.08);
  take(track, at_x(0.02), 10.02, 0.08);
  EXPECT_NEAR(track.at(0.0).pose.position_m.x, 0.1, 1e-9);
  EXPECT_NEAR(track.at(0.01).pose.position_m.x, 0.11, 1e-9);
}

TEST(PoseTrack, WithoutANewerPoseItGoesOnForAnIntervalAndStandsStillThen) {
  PoseTrack fast, slow;
  take(fast, at_x(0.0), 0.0), take(fast, at_x(0.01), 0.01);
  take(slow, at_x(0.0), 0.0), take(slow, at_x(0.3), 0.3);
  EXPECT_NEAR(fast.at(0.1).pose.position_m.x, 0.11, 1e-9);
  EXPECT_EQ(fast.at(0.1).velocity_m_s.x, 1.0);
  EXPECT_NEAR(fast.at(0.4).pose.position_m.x, 0.11, 1e-9);
  EXPECT_EQ(fast.at(0.4).velocity_m_s.x, 0.0);
  EXPECT_NEAR(slow.at(0.3).pose.position_m.x, 0.6, 1e-9);
  EXPECT_NEAR(slow.at(9.0).pose.position_m.x, 0.6, 1e-9);
}

TEST(PoseTrack, ABurstOfPosesDoesNotDifferentiateNoise) {
  PoseTrack track;
  take(track, at_x(0.0), 0.0);
  // 1 m/s at 100 kHz, with a noise of 0.1 mm: 10 m/s from one pose to the next.
  for (int i = 1; i <= 3000; ++i) {
    take(track, at_x(1e-5 * i + (i % 2 == 0 ? 1e-4 : -1e-4)), 1e-5 * i);
    EXPECT_LT(std::abs(track.at(0.0).velocity_m_s.x - 1.0), 1.01) << i;
  }
  EXPECT_NEAR(track.at(0.0).pose.position_m.x, 0.03, 2e-4);
}

TEST(PoseTrack, JumpsGapsAndEqualTimesGiveNoSpeed) {
  PoseTrack track;
  take(track, at_x(0.0), 1.0), take(track, at_x(0.02), 1.01);
  take(track, at_x(40.0), 1.02);  // 4000 m/s
  EXPECT_EQ(track.at(0.1).pose.position_m.x, 40.0);
  take(track, at_x(40.01), 1.03);
  EXPECT_NEAR(track.at(0.0).velocity_m_s.x, 1.0, 1e-6);
  take(track, at_x(40.02), 1.03);  // the same instant again: only the place counts
  EXPECT_EQ(track.at(0.0).pose.position_m.x, 40.02);
  EXPECT_NEAR(track.at(0.0).velocity_m_s.x, 1.0, 1e-6);
  take(track, at_x(41.0), 1.03 + 2.0 * kHold_s);
  EXPECT_EQ(track.at(0.0).velocity_m_s.x, 0.0);
  take(track, at_x(42.0), 1.0);  // another clock, after a restore
  EXPECT_EQ(track.at(0.0).velocity_m_s.x, 0.0);
  take(track, {.world_from_object = {Vec3(42.0, 0, 0), Quat(0.0, 0.0, 1.0, 0.0)}}, 1.005);
  EXPECT_EQ(track.at(0.0).angular_velocity_rad_s, Vec3(0.0));  // half a turn in 5 ms
}

TEST(PoseTrack, MeasuredVelocitiesCountAsTheyAre) {
  PoseTrack track;
  ObjectPose boat = at_x(5.0);
  boat.velocity_m_s = {2.0, 0.0, 0.0};
  boat.measured = 1;
  take(track, boat, 0.0);
  EXPECT_EQ(track.at(0.05).velocity_m_s.x, 2.0);
  EXPECT_NEAR(track.at(0.05).pose.position_m.x, 5.1, 1e-12);
}

TEST(PoseTrack, ExtremePosesAndTimesGiveFiniteMotion) {
  const double most = std::numeric_limits<double>::max();
  for (const double x : {0.0, 5e-324, 1e-300, kFarthest_m, -kFarthest_m})
    for (const TimeNs time : {TimeNs{0}, TimeNs{1}, std::numeric_limits<TimeNs>::max(),
                              std::numeric_limits<TimeNs>::min()})
      for (const double after_s : {0.0, 1e-9, 0.1, 1e9}) {
        PoseTrack track;
        take(track, at_x(-x), 0.0), take(track, at_x(0.0), 1e-3);
        track.take(at_x(x), {.captured_ns = time, .arrived_ns = -(time / 2)}, most);
        const Motion at = track.at(after_s);
        EXPECT_TRUE(sim::all_finite(at) && sim::all_finite(track)) << x << " " << time;
      }
}

TEST(ObjectInputs, ANewAuthorityForgetsThePosesOfTheOldOne) {
  StreamTable table;
  table.add_object("prop");
  ObjectInputs inputs = autopilot_object();
  const auto say = [&](SourceId source, double x_m, double at_s) {
    return apply(inputs, sample_of(table, "prop/pose", source, 0, at_x(x_m), ns(at_s)), 0);
  };
  EXPECT_FALSE(say(1, 0.0, 0.0));
  EXPECT_EQ(inputs.control[0].unheeded, 1u);
  const auto authority = [&](std::uint64_t by, std::uint64_t source) {
    return apply(
        inputs,
        sample_of(table, "prop/event", 9, 0, Event{EventKind::kSetAuthority, 0, by, source, 0.0}),
        0);
  };
  const auto live = static_cast<std::uint64_t>(Authority::kLive);
  EXPECT_TRUE(authority(live, 1));
  EXPECT_TRUE(say(1, 0.0, 0.0) && say(1, 0.01, 0.01));
  EXPECT_NEAR(inputs.track.at(0.0).velocity_m_s.x, 1.0, 1e-6);
  EXPECT_TRUE(authority(live, 2));
  EXPECT_TRUE(say(2, 0.1, 0.02));
  EXPECT_EQ(inputs.track.at(0.0).velocity_m_s.x, 0.0);
  // An object has no recording of its own, and one group.
  EXPECT_FALSE(authority(static_cast<std::uint64_t>(Authority::kRecording), 0));
  EXPECT_FALSE(apply(
      inputs,
      sample_of(table, "prop/event", 9, 0, Event{EventKind::kSetAuthority, 1, live, 1, 0.0}), 0));
  EXPECT_EQ(inputs.refused_events, 2u);
}

}  // namespace
}  // namespace neritic::testbed
