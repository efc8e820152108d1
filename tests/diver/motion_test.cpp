// How limbs move the body: momentum and energy kept, symmetry, closed forms, convergence.
#include <gtest/gtest.h>

#include "tests/diver/bodies.hpp"

namespace neritic::diver {
namespace {

struct Free {
  Body body;
  RootState root;
  LimbState limbs;
  GasLoad load;
};

void swing(Free& f, std::uint64_t index, double t, double dt) {
  const LimbState before = f.limbs;
  follow_limbs(f.limbs, swinging(index, t), dt);
  move_root(f.body, f.root, before, f.limbs, f.load, Vec3(0.0), dt);
}

TEST(Momentum, LimbsAloneChangeNeitherInVacuumNorInWaterWithoutDrag) {
  for (const double water : {0.0, 1025.0})
    for (const double dt : {1.0 / 1000.0, 1.0 / 240.0, 1.0 / 60.0})
      for (std::uint64_t index = 0; index < 4; ++index) {
        Free f{weightless(without_drag(body_with(Gear{}, Model::kFull, water)))};
        f.root.position_ned_m = {3.0, -2.0, 20.0};
        f.root.attitude = HumanDraws(index).attitude();
        f.root.velocity = vec6(HumanDraws(index + 9).vec3(0.5), HumanDraws(index + 20).vec3(0.3));
        f.limbs.rotation = swinging(index, 0.0);
        const Vec3 about(1.0, 1.0, 18.0);
        const WorldMomentum start = world_momentum(f.body, f.root, f.limbs, f.load, about);
        for (int i = 0; i * dt < 5.0; ++i) swing(f, index, i * dt, dt);
        const WorldMomentum end = world_momentum(f.body, f.root, f.limbs, f.load, about);
        EXPECT_LT(glm::length(end.linear_ned - start.linear_ned), 1e-9) << water << " " << dt;
        EXPECT_LT(glm::length(end.angular_ned - start.angular_ned), 1e-9) << water << " " << dt;
      }
}

TEST(Momentum, WhoStartsAtRestTurnsByLimbsButGoesNowhere) {
  Free f{weightless(body_with(Gear{}, Model::kFull, 0.0))};
  f.limbs.rotation = swinging(1, 0.0);
  const auto centre = [&] {
    const MassProperties m =
        mass_properties(f.body, posture_of(f.body, f.limbs.rotation, f.limbs.rate));
    return f.root.position_ned_m + f.root.attitude * m.centre_m;
  };
  const Vec3 start = centre();
  double turned = 0.0;
  for (int i = 0; i < 2400; ++i) {
    swing(f, 1, i / 240.0, 1.0 / 240.0);
    turned = std::max(turned, 2.0 * std::acos(std::min(1.0, std::abs(f.root.attitude.w))));
  }
  EXPECT_LT(glm::length(centre() - start), 0.002);
  EXPECT_GT(turned, 0.05);
}

TEST(Momentum, TheCentreKeepsItsPlaceToSecondOrder) {
  const auto drift = [](double dt) {
    Free f{weightless(body_with(Gear{}, Model::kFull, 0.0))};
    f.limbs.rotation = swinging(2, 0.0);
    const auto centre = [&] {
      const MassProperties m =
          mass_properties(f.body, posture_of(f.body, f.limbs.rotation, f.limbs.rate));
      return f.root.position_ned_m + f.root.attitude * m.centre_m;
    };
    const Vec3 start = centre();
    for (int i = 0; i * dt < 3.0 - 1e-9; ++i) swing(f, 2, i * dt, dt);
    return glm::length(centre() - start);
  };
  const double coarse = drift(0.01), fine = drift(0.005);
  EXPECT_LT(coarse, 0.01);
  EXPECT_LT(fine, 0.4 * coarse);
}

TEST(Momentum, InVacuumEverythingFalls) {
  Free f{body_with(Gear{}, Model::kFull, 0.0)};
  f.root.attitude = HumanDraws(7).attitude();
  f.limbs.rotation = swinging(5, 0.0);
  const double kg = dry_mass(f.body);
  for (int i = 0; i < 240; ++i) swing(f, 5, i / 240.0, 1.0 / 240.0);
  const WorldMomentum m = world_momentum(f.body, f.root, f.limbs, f.load, f.root.position_ned_m);
  EXPECT_NEAR(m.linear_ned.z, kg * kGravity_m_s2, 1e-6);
  EXPECT_NEAR(m.linear_ned.x, 0.0, 1e-9);
}

TEST(Energy, NeverGrowsWhereLimbsRest) {
  for (std::uint64_t index = 0; index < 40; ++index) {
    HumanDraws draws(index);
    Free f{weightless(body_with(Gear{}))};
    const double dt = draws.uniform(0.001, 1.0 / 60.0);
    f.root.position_ned_m.z = 20.0;
    f.root.attitude = draws.attitude();
    f.root.velocity = vec6(draws.vec3(8.0), draws.vec3(8.0));
    f.limbs = draws.limbs(0.8, 0.0);
    double energy = kinetic_energy(f.body, f.root, f.limbs, f.load);
    const double start = energy;
    for (int i = 0; i < 300; ++i) {
      move_root(f.body, f.root, f.limbs, f.limbs, f.load, Vec3(0.0), dt);
      const double now = kinetic_energy(f.body, f.root, f.limbs, f.load);
      ASSERT_LE(now, energy + 1e-6 * start) << index << " dt " << dt << " step " << i;
      energy = now;
    }
  }
}

TEST(Energy, WhatLimbsGiveIsWhatWaterTakes) {
  // Over whole beats of a steady kick nothing is left over: power in, drag out.
  const Body body = weightless(body_with(Gear{}));
  Free f{body};
  f.root.position_ned_m.z = 15.0;
  FlutterKick kick;
  JointAngles joints = streamlined(body);
  set_flutter(joints, body, kick, 0.0);
  f.limbs.rotation = rotations_of(joints);
  double given_j = 0.0, taken_j = 0.0;
  constexpr double dt = 1.0 / 480.0;
  double before_j = 0.0;
  for (int i = 0; i < 10 * 480; ++i) {
    set_flutter(joints, body, kick, 2.0 * kPi * i * dt);
    const LimbState old = f.limbs;
    follow_limbs(f.limbs, rotations_of(joints), dt);
    const double work_j =
        move_root(f.body, f.root, old, f.limbs, f.load, Vec3(0.0), dt).power_w * dt;
    if (i == 8 * 480) before_j = kinetic_energy(f.body, f.root, f.limbs, f.load);
    if (i < 8 * 480) continue;
    given_j += work_j;
    taken_j -=
        dt * water_forces(f.body, posture_of(f.body, f.limbs.rotation, f.limbs.rate),
                          f.root.velocity, {glm::conjugate(f.root.attitude) * Vec3(0, 0, 1), 15.0})
                 .power_w;
  }
  const double gained_j = kinetic_energy(f.body, f.root, f.limbs, f.load) - before_j;
  EXPECT_GT(given_j, 100.0);
  EXPECT_NEAR(given_j, taken_j + gained_j, 0.01 * given_j);
}

TEST(Symmetry, LeftAndRightExchangedIsTheMirrorImage) {
  const Body body = body_with(Gear{});
  RootState a, b;
  a.position_ned_m = {0.0, 1.0, 12.0};
  b.position_ned_m = {0.0, -1.0, 12.0};
  const auto mirror = [](const Quat& q) { return Quat(q.w, -q.x, q.y, -q.z); };
  a.attitude = HumanDraws(5).attitude();
  b.attitude = mirror(a.attitude);
  LimbState left, right;
  left.rotation = swinging(6, 0.0);
  right.rotation = mirrored(left.rotation);
  const GasLoad load = neutral_load(body, 12.0);
  for (int i = 0; i < 720; ++i) {
    const double dt = 1.0 / 240.0;
    const LimbState old_left = left, old_right = right;
    const JointRotations wanted = swinging(6, i * dt);
    follow_limbs(left, wanted, dt);
    follow_limbs(right, mirrored(wanted), dt);
    move_root(body, a, old_left, left, load, Vec3(0.2, 0.1, 0.0), dt);
    move_root(body, b, old_right, right, load, Vec3(0.2, -0.1, 0.0), dt);
  }
  EXPECT_GT(glm::length(a.position_ned_m - Vec3(0.0, 1.0, 12.0)), 0.1);
  EXPECT_NEAR(a.position_ned_m.x, b.position_ned_m.x, 1e-9);
  EXPECT_NEAR(a.position_ned_m.y, -b.position_ned_m.y, 1e-9);
  EXPECT_NEAR(a.position_ned_m.z, b.position_ned_m.z, 1e-9);
  EXPECT_NEAR(std::abs(glm::dot(mirror(a.attitude), b.attitude)), 1.0, 1e-9);
  for (const std::size_t same : {0u, 2u, 4u}) EXPECT_NEAR(a.velocity[same], b.velocity[same], 1e-9);
  for (const std::size_t other : {1u, 3u, 5u})
    EXPECT_NEAR(a.velocity[other], -b.velocity[other], 1e-9);
}

TEST(Symmetry, ACurrentCarriesEverythingAlong) {
  const Body body = body_with(Gear{});
  const GasLoad load = neutral_load(body, 12.0);
  const Vec3 current(0.4, -0.3, 0.0);
  RootState still, carried;
  still.position_ned_m.z = carried.position_ned_m.z = 12.0;
  carried.velocity = vec6(current, Vec3(0.0));
  LimbState limbs;
  limbs.rotation = swinging(8, 0.0);
  constexpr double dt = 1.0 / 240.0;
  for (int i = 0; i < 480; ++i) {
    const LimbState before = limbs;
    follow_limbs(limbs, swinging(8, i * dt), dt);
    move_root(body, still, before, limbs, load, Vec3(0.0), dt);
    move_root(body, carried, before, limbs, load, current, dt);
  }
  EXPECT_LT(glm::length(carried.position_ned_m - still.position_ned_m - 2.0 * current), 1e-9);
  EXPECT_NEAR(std::abs(glm::dot(carried.attitude, still.attitude)), 1.0, 1e-12);
}

TEST(ClosedForm, AGlideSlowsDownAsOneOverTime) {
  // v0 / (1 + t / tau), tau = 2 (m + m_a) / (rho C_d A v0); gliding level, held there.
  const Body body = body_with(Gear{});
  const JointAngles line = streamlined(body);
  LimbState limbs;
  limbs.rotation = rotations_of(line);
  const Posture posture = posture_of(body, limbs.rotation, {});
  const GasLoad load = neutral_load(body, 12.0);
  const double mass_kg = momentum_of(body, posture, load).mass.a[0][0];
  const double added_kg = mass_kg - dry_mass(body) - load.tank_kg[0];
  EXPECT_GT(added_kg, 0.04 * mass_kg);
  EXPECT_LT(added_kg, 0.10 * mass_kg);
  const double v0 = 0.8, area = drag_area(body, line, 0.0);
  const double tau_s = 2.0 * mass_kg / (1025.0 * area * v0);
  RootState root;
  root.position_ned_m.z = 12.0;
  root.velocity[0] = v0;
  for (int i = 0; i < 480; ++i) {
    move_root(body, root, limbs, limbs, load, Vec3(0.0), 1.0 / 240.0);
    root.attitude = Quat(1.0, 0.0, 0.0, 0.0);
    root.velocity = vec6({root.velocity[0], 0.0, 0.0}, Vec3(0.0));
  }
  EXPECT_NEAR(root.velocity[0], v0 / (1.0 + 2.0 / tau_s), 2e-3);
  EXPECT_NEAR(root.position_ned_m.x, v0 * tau_s * std::log1p(2.0 / tau_s), 5e-3);
}

// One kilogram too heavy sinks at 0.255 m/s where C_d A is 0.30, at 0.159 where it is 0.77; five
// litres too light rise at 0.357 flat: v = sqrt(2 F / (rho C_d A)).
TEST(ClosedForm, SinkingAndRisingEndAtTheirTerminalSpeeds) {
  EXPECT_NEAR(std::sqrt(2.0 * 10.0 / (1025.0 * 0.30)), 0.25503, 1e-5);
  struct Case {
    double down_n, pitch_deg, low_m_s, high_m_s;
  };
  const Case cases[] = {{10.0, -90.0, 0.22, 0.29},   // head down, trim's area
                        {10.0, 0.0, 0.13, 0.18},     // flat
                        {-50.26, 0.0, 0.29, 0.40}};  // flat, five litres of lift
  Gear gear;
  gear.fins.reset();
  const Body body = body_with(gear);
  const JointAngles line = streamlined(body);
  LimbState limbs;
  limbs.rotation = rotations_of(line);
  for (const Case& c : cases) {
    RootState root;
    root.attitude = glm::angleAxis(radians(c.pitch_deg), Vec3(0, 1, 0));
    const Quat attitude = root.attitude;
    // Lift through the middle of what moves; what drag still turns is held (some per cent).
    GasLoad load = neutral_load(body, 30.0);
    load.jacket_m3 = -c.down_n / (1025.0 * kGravity_m_s2);
    const Posture posture = posture_of(body, limbs.rotation, {});
    const Immersion immersion{glm::conjugate(attitude) * Vec3(0, 0, 1), 30.0};
    const SpatialMass mass = momentum_of(body, posture, load).mass;
    const double middle_m = c.pitch_deg == 0.0 ? -mass.b[1][2] / mass.a[2][2] : 0.0;
    const auto turning = [&](double at_m) {
      load.jacket_at_m = {at_m, 0.0, 0.0};
      const Vec6 w = static_forces(body, posture, {}, immersion, load).wrench;
      return w[4] + middle_m * w[2];
    };
    const double at_zero = turning(0.0);
    if (c.pitch_deg == 0.0) turning(-at_zero / (turning(1.0) - at_zero));
    for (int i = 0; i < 40 * 240; ++i) {
      root.position_ned_m = {0.0, 0.0, 30.0};  // the suit's gas stays as it is
      move_root(body, root, limbs, limbs, load, Vec3(0.0), 1.0 / 240.0);
      const double down_m_s = (root.attitude * root.velocity.linear()).z;
      root.attitude = attitude;
      root.velocity = vec6(glm::conjugate(attitude) * Vec3(0.0, 0.0, down_m_s), Vec3(0.0));
    }
    const double speed = (root.attitude * root.velocity.linear()).z;
    // Its own area along the way, which is the pitch away from vertical.
    const double area =
        drag_area(body, line, c.pitch_deg == 0.0 ? (c.down_n > 0.0 ? 90.0 : -90.0) : 0.0);
    const double closed = std::sqrt(2.0 * std::abs(c.down_n) / (1025.0 * area));
    EXPECT_NEAR(std::abs(speed), closed, 0.05 * closed) << c.pitch_deg;
    EXPECT_GT(std::abs(speed), c.low_m_s) << c.pitch_deg;
    EXPECT_LT(std::abs(speed), c.high_m_s) << c.pitch_deg;
    EXPECT_EQ(speed > 0.0, c.down_n > 0.0);
  }
}

// White noise of a millimetre at the end of limbs of 0.6 m, at 120 Hz, differenced twice would be
// 35 m/s^2 and kilonewtons.
TEST(LimbFilter, SensorNoiseAtRestMovesNobody) {
  const Body body = body_with(Gear{});
  const GasLoad load = neutral_load(body, 12.0);
  RootState root;
  root.position_ned_m.z = 12.0;
  LimbState limbs;
  JointRotations measured = straight_joints();
  HumanDraws draws(11);
  constexpr double dt = 1.0 / 240.0;
  double fastest = 0.0;
  Vec3 impulse(0.0);
  for (int i = 0; i < 20 * 240; ++i) {
    if (i % 2 == 0) {
      JointAngles noise;
      for (Vec3& joint : noise)
        for (int axis = 0; axis < 3; ++axis) {  // nearly normal
          double sum = 0.0;
          for (int k = 0; k < 12; ++k) sum += draws.uniform(-0.5, 0.5);
          joint[axis] = 0.001 / 0.6 * sum;
        }
      measured = rotations_of(noise);
    }
    const LimbState before = limbs;
    const Vec3 old = root.velocity.linear();
    follow_limbs(limbs, measured, dt);
    move_root(body, root, before, limbs, load, Vec3(0.0), dt);
    for (const Vec3& rate : limbs.rate) fastest = std::max(fastest, glm::length(rate));
    impulse += 150.0 * (root.velocity.linear() - old);
  }
  EXPECT_LT(fastest, 0.2);                     // rad/s
  EXPECT_LT(std::abs(impulse.x) / 20.0, 1.0);  // mean thrust, N
  EXPECT_LT(std::abs(impulse.y) / 20.0, 1.0);
  EXPECT_LT(std::abs(root.position_ned_m.x), 0.1);
}

TEST(LimbFilter, PassesAKickAndStopsTremor) {
  const auto gain = [](double hz) {
    LimbState limbs;
    double most = 0.0;
    for (int i = 0; i < 2400; ++i) {
      JointAngles a{};
      a[9].y = 0.2 * std::sin(2.0 * kPi * hz * i / 240.0);
      follow_limbs(limbs, rotations_of(a), 1.0 / 240.0);
      if (i > 1200) most = std::max(most, std::abs(angles_of(limbs.rotation)[9].y));
    }
    return most / 0.2;
  };
  EXPECT_NEAR(gain(1.0), 1.0, 0.005);
  EXPECT_NEAR(gain(6.0), std::sqrt(0.5), 0.02);
  EXPECT_NEAR(gain(24.0), 1.0 / 16.0, 0.01);
}

TEST(LimbFilter, GivesTheRateOfWhatItFollows) {
  LimbState limbs;
  for (int i = 0; i < 480; ++i) {
    JointAngles a{};
    a[0].y = 0.5 * i / 240.0;
    follow_limbs(limbs, rotations_of(a), 1.0 / 240.0);
  }
  EXPECT_NEAR(limbs.rate[0].y, 0.5, 2e-3);
}

TEST(Planar, InPlaneMotionIsThatOfTheFullModel) {
  // Both legs together keep the full model in the plane: then they agree but for head and arms.
  const Body full = body_with(Gear{}), planar = body_with(Gear{}, Model::kPlanar);
  const GasLoad load = neutral_load(full, 15.0);
  RootState a, b;
  a.position_ned_m.z = b.position_ned_m.z = 15.0;
  LimbState limbs;
  constexpr double dt = 1.0 / 240.0;
  for (int i = 0; i < 720; ++i) {
    JointAngles joints{};
    const double s = std::sin(2.0 * kPi * 0.8 * i * dt), c = std::cos(2.0 * kPi * 0.8 * i * dt);
    for (const Segment foot : {kLeftFoot, kRightFoot}) {
      joints[joint_of(foot)].y = -1.2 + 0.2 * c;
      joints[joint_of(foot) - 1].y = -0.3 + 0.2 * c;
      joints[joint_of(foot) - 2].y = 0.2 * s;
    }
    joints[joint_of(kThorax)].y = 0.05 * s;
    const LimbState before = limbs;
    follow_limbs(limbs, rotations_of(joints), dt);
    move_root(full, a, before, limbs, load, Vec3(0.0), dt);
    move_root(planar, b, before, limbs, load, Vec3(0.0), dt);
  }
  EXPECT_GT(std::abs(a.position_ned_m.x), 0.2);
  EXPECT_LT(glm::length(a.position_ned_m - b.position_ned_m), 1e-6);
  EXPECT_EQ(b.position_ned_m.y, 0.0);
  EXPECT_EQ(b.velocity[1], 0.0);
  EXPECT_EQ(b.velocity[3], 0.0);
}

}  // namespace
}  // namespace neritic::diver
