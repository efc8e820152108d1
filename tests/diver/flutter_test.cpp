// The flutter kick against what was measured on people: speed for each beat, power, joints.
#include <gtest/gtest.h>

#include "tests/diver/bodies.hpp"

namespace neritic::diver {
namespace {

FlutterKick of(double amplitude_m) {
  FlutterKick kick;
  kick.amplitude_m = amplitude_m;
  return kick;
}

// Zamparo et al. (2002): 0.93 m for each beat with fins, 0.51 m without (swimmers without tanks).
TEST(Flutter, SpeedIsProportionalToFrequencyAsPublished) {
  for (const double hz : {0.5, 0.75, 1.0, 1.4}) {
    const KickRun with = kick_steadily(fins_only(), of(0.20), hz, 24.0);
    const KickRun without = kick_steadily(no_gear(), of(0.20), hz, 24.0);
    EXPECT_NEAR(with.speed_m_s / hz, 0.93, 0.10) << hz;
    EXPECT_NEAR(without.speed_m_s / hz, 0.51, 0.08) << hz;
    // Froude efficiency of the wave, (c + v) / 2 c: 0.70 and 0.61.
    const double c = 2.33 * hz;
    EXPECT_NEAR((c + with.speed_m_s) / (2.0 * c), 0.70, 0.03);
    EXPECT_NEAR((c + without.speed_m_s) / (2.0 * c), 0.61, 0.03);
  }
}

// With a tank, C_d A 0.295: a strip model with the same wave gives 0.65 m for each beat at an
// amplitude of 0.30, 0.43 at 0.20 (surge alone).
TEST(Flutter, ADiverSwimsHalfAMetreASecondForTheStrengthOfAPerson) {
  EXPECT_NEAR(kick_steadily(Gear{}, of(0.30), 1.0).speed_m_s, 0.65, 0.08);
  EXPECT_NEAR(kick_steadily(Gear{}, of(0.20), 1.0).speed_m_s, 0.43, 0.05);
  const KickRun cruise = kick_steadily(Gear{}, FlutterKick{}, 0.9);
  EXPECT_NEAR(cruise.speed_m_s, 0.48, 0.05);  // sustained for long: about a knot
  EXPECT_LT(cruise.power_w, 130.0);
  EXPECT_GT(cruise.power_w, 40.0);
  const KickRun fast = kick_steadily(Gear{}, FlutterKick{}, 1.3);
  EXPECT_GT(fast.speed_m_s, 0.65);
  EXPECT_LT(fast.power_w, 300.0);
  // Hardly any work is given back by the water.
  EXPECT_LT(cruise.positive_power_w, 1.1 * cruise.power_w);
}

TEST(Flutter, PowerGrowsWithTheCubeOfFrequency) {
  const double one = kick_steadily(Gear{}, FlutterKick{}, 0.5, 20.0).power_w;
  const double two = kick_steadily(Gear{}, FlutterKick{}, 1.0, 20.0).power_w;
  EXPECT_NEAR(two / one, 8.0, 0.3);
}

// The same joint angles with a phase of their own each: how not to swim.
TEST(Flutter, ArbitraryPhasesCostManyTimesThePower) {
  const Body diver = body_with(Gear{});
  const auto cost = [&](double knee_phase, double ankle_phase) {
    RootState root;
    root.position_ned_m.z = 15.0;
    const GasLoad load = neutral_load(diver, 15.0);
    LimbState limbs;
    limbs.rotation = rotations_of(streamlined(diver));
    double way_m = 0.0, work_j = 0.0;
    for (int i = 0; i < 10 * 240; ++i) {
      const double dt = 1.0 / 240.0, phase = 2.0 * kPi * i * dt;
      JointAngles joints = streamlined(diver);
      for (const bool right : {false, true}) {
        const double p = phase + (right ? kPi : 0.0);
        const std::size_t hip = joint_of(right ? kRightUpperLeg : kLeftUpperLeg);
        joints[hip].y = radians(20.0) * std::sin(p);
        joints[hip + 1].y = radians(-25.0) + radians(25.0) * std::sin(p + knee_phase);
        joints[hip + 2].y += radians(30.0) * std::sin(p + ankle_phase);
      }
      const LimbState before = limbs;
      follow_limbs(limbs, rotations_of(joints), dt);
      const LimbWork work = move_root(diver, root, before, limbs, load, Vec3(0.0), dt);
      root.attitude = Quat(1.0, 0.0, 0.0, 0.0);
      if (i < 5 * 240) continue;
      way_m += root.velocity[0] * dt;
      work_j += work.power_w * dt;
    }
    return std::array{way_m / 5.0, work_j / 5.0};
  };
  const KickRun good = kick_steadily(Gear{}, FlutterKick{}, 1.0);
  const auto bad = cost(1.9, 2.2);
  EXPECT_GT(bad[1], 3.0 * good.power_w);
  EXPECT_LT(bad[0], good.speed_m_s);
}

TEST(Flutter, JointsStayInTheRangeOfPeople) {
  for (const Gear& gear : {Gear{}, no_gear()}) {
    const Body body = body_with(gear);
    for (const double amplitude_m : {0.1, 0.2, 0.25, 0.30})
      for (int i = 0; i < 100; ++i) {
        JointAngles joints = streamlined(body);
        set_flutter(joints, body, of(amplitude_m), 2.0 * kPi * i / 100.0);
        for (const Segment leg : {kLeftUpperLeg, kRightUpperLeg}) {
          const double hip = degrees(joints[joint_of(leg)].y);
          const double knee = degrees(joints[joint_of(leg) + 1].y);
          const double ankle = degrees(joints[joint_of(leg) + 2].y);
          EXPECT_GT(hip, -15.0);
          EXPECT_LT(hip, 40.0);
          EXPECT_LE(knee, 0.0);
          EXPECT_GT(knee, -70.0);
          EXPECT_LE(ankle, 0.0);
          EXPECT_GE(ankle, -90.0 - 1e-9);
        }
      }
  }
}

TEST(Flutter, TheRightLegIsHalfABeatBehindTheLeft) {
  const Body body = body_with(Gear{});
  JointAngles a = streamlined(body), b = a;
  set_flutter(a, body, FlutterKick{}, 0.7);
  set_flutter(b, body, FlutterKick{}, 0.7 + kPi);
  for (const Segment s : {kLeftUpperLeg, kLeftLowerLeg, kLeftFoot})
    EXPECT_NEAR(a[joint_of(s)].y, b[joint_of(kMirror[s])].y, 1e-12);
}

// The error falls with the square of the step: 0.2 % at 240 Hz, 3.5 % at 60 Hz (joints held
// between).
TEST(Flutter, SpeedDoesNotDependOnTheStep) {
  const double truth = kick_steadily(Gear{}, FlutterKick{}, 1.0, 14.0, 1.0 / 1000.0).speed_m_s;
  EXPECT_NEAR(kick_steadily(Gear{}, FlutterKick{}, 1.0, 14.0, 1.0 / 240.0).speed_m_s, truth,
              3e-3 * truth);
  EXPECT_NEAR(kick_steadily(Gear{}, FlutterKick{}, 1.0, 14.0, 1.0 / 60.0).speed_m_s, truth,
              4e-2 * truth);
}

}  // namespace
}  // namespace neritic::diver
