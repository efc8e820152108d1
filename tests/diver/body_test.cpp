// The whole body: centre, inertia, density, joints; drag in trim and out of it.
#include <gtest/gtest.h>

#include "diver/water_forces.hpp"
#include "tests/diver/bodies.hpp"

namespace neritic::diver {
namespace {

Body naked(const Build& build, double water_kg_m3 = kSeaWater_kg_m3) {
  BodyParameters p;
  p.build = build;
  p.gear = no_gear();
  p.water_kg_m3 = water_kg_m3;
  return make_body(p).value();
}

// De Leva's mean man standing, arms down: centre 7.1 cm above the hips, which is 57 to 58 % of the
// height; moment about the side-to-side axis 11.78 kg m^2.
TEST(Body, StandingHasTheCentreAndInertiaOfTheTables) {
  const Body body = naked({Sex::kMale, 1.741, 73.0});
  const MassProperties m = mass_properties(body, posture_of(body, straight_joints(), {}));
  EXPECT_NEAR(m.mass_kg, 73.0, 1e-9);
  EXPECT_NEAR(m.centre_m.x, 0.071, 0.05 * 0.071);
  EXPECT_NEAR(m.centre_m.y, 0.0, 1e-12);
  const double hips_m = (0.4222 + 0.434) + 0.039 * 1.741;  // thigh, shank, and the ankle's height
  EXPECT_GT((hips_m + m.centre_m.x) / 1.741, 0.565);
  EXPECT_LT((hips_m + m.centre_m.x) / 1.741, 0.585);
  EXPECT_NEAR(m.inertia_kg_m2[1][1], 11.78, 0.05 * 11.78);
  // Front to back it is a little more, along the body a tenth.
  EXPECT_NEAR(m.inertia_kg_m2[2][2], 12.7, 1.0);
  EXPECT_NEAR(m.inertia_kg_m2[0][0], 1.2, 0.3);
  EXPECT_NEAR(m.inertia_kg_m2[0][1], 0.0, 1e-12);
}

TEST(Body, DensityIsThatOfPeopleWithTheirLungs) {
  for (const Build build : {Build{}, Build{Sex::kFemale, 1.67, 62.0}}) {
    const Body body = naked(build);
    const double tissue_m3 = solid_volume(body, 0.0);
    const auto density = [&](double lungs_m3) { return dry_mass(body) / (tissue_m3 + lungs_m3); };
    EXPECT_NEAR(density(0.0), 1060.0, 10.0);
    EXPECT_GT(density(body.lungs.residual_m3), 1030.0);
    EXPECT_LT(density(body.lungs.residual_m3), 1070.0);
    EXPECT_NEAR(density(body.lungs.total_m3), 980.0, 10.0);
  }
}

TEST(Body, SuitGasIsHalfAtTenMetresAndAQuarterAtThirty) {
  const Body body = body_with(Gear{});
  const double solid = solid_volume(body, 1e9);
  const double gas = solid_volume(body, 0.0) - solid;
  EXPECT_NEAR((solid_volume(body, 10.0) - solid) / gas, 0.50200, 1e-4);
  EXPECT_NEAR((solid_volume(body, 20.0) - solid) / gas, 0.33511, 1e-4);
  EXPECT_NEAR((solid_volume(body, 30.0) - solid) / gas, 0.25150, 1e-4);
  // 5 mm lift some 3 kg at the surface.
  const Body bare = naked({});
  Gear suit = no_gear();
  suit.suit = Suit{};
  const Body suited = body_with(suit);
  const double lift_kg = 1025.0 * (solid_volume(suited, 0.0) - solid_volume(bare, 0.0)) -
                         (dry_mass(suited) - dry_mass(bare));
  EXPECT_NEAR(lift_kg, 3.0, 0.5);
}

TEST(Body, LeadMakesNeutralAsOneChecksIt) {
  for (const double suit_m : {0.003, 0.005, 0.007}) {
    Gear gear;
    gear.suit->thickness_m = suit_m;
    gear.tanks[0].pressure_pa = 50e5;
    const Body body = body_with(gear);
    GasLoad load;
    load.tank_kg[0] = full_tanks(body).moles[0] * molar_mass(kAir);
    load.lungs_m3 = body.lungs.rest_m3 + 0.25e-3;
    const StaticForces f = static_forces(body, posture_of(body, straight_joints(), {}), {},
                                         {{0.0, 0.0, 1.0}, 5.0}, load);
    EXPECT_NEAR(f.wrench[2], 0.0, 0.3) << suit_m;
    EXPECT_GT(body.lead_kg, 0.5) << suit_m;
    EXPECT_LT(body.lead_kg, 8.0) << suit_m;
  }
}

// Still, at 15 m with 120 bar in every tank: the moment of weight and buoyancy about the body's
// length.
double roll_moment_n_m(const Gear& gear) {
  const Body body = body_with(gear);
  HumanState state =
      start_at(body, {0.0, 0.0, 15.0}, Quat(1.0, 0.0, 0.0, 0.0), rotations_of(JointAngles{}));
  for (std::size_t i = 0; i < body.tank_count; ++i)
    state.life.tanks.moles[i] = moles_in(body.tanks[i].mix, body.tanks[i].water_volume_m3, 120e5);
  const Immersion still{Vec3(0.0, 0.0, 1.0), 15.0};
  return static_forces(body, posture_of(body, state.limbs.rotation, {}), {}, still,
                       gas_load(body, state))
      .wrench.angular()
      .x;
}

TEST(Body, LeadLiesWhereItBalancesTanksAtASide) {
  Tank stage = tank_of(0.007);
  stage.mix.oxygen = 0.5;
  Gear gear;
  gear.tanks = {Tank{}, stage};
  EXPECT_NEAR(roll_moment_n_m(gear), 0.0, 1e-6);
  stage.empty_mass_kg += 1.5;  // lead as far to the other side as a belt goes does not do
  gear.tanks = {Tank{}, stage};
  EXPECT_LT(roll_moment_n_m(gear), -0.1);
}

TEST(Body, TwoTanksAlikeAreATwinSet) {
  Gear gear;
  gear.tanks = {tank_of(0.012), tank_of(0.012), tank_of(0.007)};
  const Body twin = body_with(gear);
  EXPECT_EQ(tanks_on_back(gear), 2u);
  EXPECT_NEAR(twin.tanks[0].position_m.y, gear.tanks[0].radius_m + 0.005, 1e-12);
  EXPECT_EQ(twin.tanks[1].position_m.y, -twin.tanks[0].position_m.y);
  EXPECT_LT(twin.tanks[2].position_m.y, -0.1);  // alone, before the ribs
  EXPECT_GT(twin.tanks[2].position_m.z, 0.1);
  gear.tanks[1].mix.oxygen = 0.5;
  EXPECT_EQ(tanks_on_back(gear), 1u);
  EXPECT_LT(body_with(gear).tanks[1].position_m.y, -0.2);
  EXPECT_GT(body_with(gear).tanks[2].position_m.y, 0.2);
}

TEST(Body, ParametersBeyondAnyDiversAreRefusedByName) {
  BodyParameters p;
  p.gear.suit->thickness_m = 0.5;
  EXPECT_EQ(make_body(p).error().message, "suit: found 0.5; accepted: 0 to 0.012");
  p = {};
  p.gear.tanks.resize(5);
  EXPECT_EQ(make_body(p).error().message, "tanks: found 5; accepted: up to 4");
  p = {};
  p.gear.tanks[0].mix = {0.9, 0.3};
  EXPECT_FALSE(make_body(p).ok());
  p = {};
  p.strips_a_segment = 0;
  EXPECT_FALSE(make_body(p).ok());
  p = {};
  p.gear.lead_kg = std::nan("");
  EXPECT_FALSE(make_body(p).ok());
}

TEST(Kinematics, AnglesAndRotationsAreInverse) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    HumanDraws draws(i);
    JointAngles angles;
    for (Vec3& a : angles)
      a = {draws.uniform(-3.1, 3.1), draws.uniform(-3.1, 3.1), draws.uniform(-1.55, 1.55)};
    const JointAngles back = angles_of(rotations_of(angles));
    for (std::size_t k = 0; k < kJoints; ++k) EXPECT_LT(glm::length(back[k] - angles[k]), 1e-7);
  }
  // Abducted by a right angle: flexion and twist are one.
  JointAngles square{};
  square[3] = {0.2, 0.5, 0.5 * kPi};
  const JointRotations q = rotations_of(square), again = rotations_of(angles_of(q));
  EXPECT_NEAR(std::abs(glm::dot(q[3], again[3])), 1.0, 1e-12);
}

TEST(Kinematics, SegmentAttitudesGiveTheSamePosture) {
  const Body body = body_with(Gear{});
  HumanDraws draws(3);
  const LimbState limbs = draws.limbs(1.0, 0.0);
  const Posture posture = posture_of(body, limbs.rotation, {});
  const Quat turned = draws.attitude();  // the suit's own axes
  std::array<Quat, kSegments> attitudes;
  for (std::size_t i = 0; i < kSegments; ++i)
    attitudes[i] = turned * glm::quat_cast(posture[i].body_from_segment);
  const Posture again = posture_of(body, rotations_of(attitudes), {});
  for (std::size_t i = 0; i < kSegments; ++i)
    EXPECT_LT(glm::length(again[i].origin_m - posture[i].origin_m), 1e-12) << i;
}

TEST(Kinematics, VelocitiesAreThoseOfMovingPoints) {
  const Body body = body_with(Gear{});
  HumanDraws draws(4);
  const LimbState limbs = draws.limbs(1.0, 2.0);
  const auto posture_at = [&](double t) {
    LimbState moved = limbs;
    for (std::size_t k = 0; k < kJoints; ++k) {
      const Vec3 v = t * limbs.rate[k];
      moved.rotation[k] = limbs.rotation[k] * glm::angleAxis(glm::length(v), glm::normalize(v));
    }
    return posture_of(body, moved.rotation, moved.rate);
  };
  constexpr double h = 1e-5;
  const Posture now = posture_of(body, limbs.rotation, limbs.rate), before = posture_at(-h),
                after = posture_at(h);
  for (std::size_t i = 0; i < kSegments; ++i) {
    const Vec3 point(0.1, -0.2, 0.3);
    const auto place = [&](const Posture& p) {
      return p[i].origin_m + p[i].body_from_segment * point;
    };
    const Vec3 velocity =
        now[i].velocity_m_s + glm::cross(now[i].angular_rad_s, now[i].body_from_segment * point);
    EXPECT_LT(glm::length((place(after) - place(before)) / (2.0 * h) - velocity), 1e-7) << i;
  }
}

// 40 N at a knot in trim, 71 N with bent knees (C_d A 0.295 and 0.524 m^2), 13 to 17 % more for 5
// degrees head up and 45 to 55 % more for 15 (Passmore and Rickers 2002); 23.5 v^2 N without gear
// (Narita et al. 2017).
TEST(Drag, InTrimAndOutOfItIsAsMeasured) {
  const Body diver = body_with(Gear{}), swimmer = body_with(no_gear());
  const JointAngles line = streamlined(diver);
  const double trim = drag_area(diver, line, 0.0);
  EXPECT_NEAR(trim, 0.2954, 0.02);
  EXPECT_NEAR(drag_area(diver, line, 5.0) / trim, 1.16, 0.03);
  EXPECT_GT(drag_area(diver, line, 15.0) / trim, 1.45);
  EXPECT_LT(drag_area(diver, line, 15.0) / trim, 1.55);
  JointAngles bent = line;
  for (const Segment leg : {kLeftLowerLeg, kRightLowerLeg}) bent[joint_of(leg)].y = -radians(53.0);
  EXPECT_NEAR(drag_area(diver, bent, 0.0), 0.524, 0.05);
  EXPECT_NEAR(drag_area(swimmer, streamlined(swimmer), 0.0), 0.0459, 0.004);
}

TEST(Drag, GrowsWithTheSquareOfSpeed) {
  const Body diver = body_with(Gear{});
  const JointAngles line = streamlined(diver);
  for (const double v : {0.01, 0.1, 1.0, 3.0})
    EXPECT_NEAR(drag_area(diver, line, 7.0, v), drag_area(diver, line, 7.0, 0.5), 1e-12);
}

TEST(Drag, FallingFlatItIsTheWidthOfTheBody) {
  // 0.7 m^2 of width times 1.1, fins aside; the strips' own sum.
  Gear gear;
  gear.fins.reset();
  const Body diver = body_with(gear);
  EXPECT_NEAR(drag_area(diver, streamlined(diver), 90.0), 0.77, 0.12);
}

// A blade turns hardest about its normal, easiest about its length: m/12 of the squares across.
TEST(Body, AFinsOwnInertiaIsThatOfAPlate) {
  Gear light = fins_only(), heavy = fins_only();
  heavy.fins->mass_kg = light.fins->mass_kg + 1.0;
  const Body a = body_with(light), b = body_with(heavy);
  const Part& blade = b.parts[b.edges[0].part];
  const Vec3 at = blade.start_m + 0.3 * blade.length_m * blade.segment_from_part[0];
  // A kilogram more, about the ankle; less what a point there has.
  Mat3 own = b.segments[kLeftFoot].rigid.c - a.segments[kLeftFoot].rigid.c -
             (glm::dot(at, at) * Mat3(1.0) - glm::outerProduct(at, at));
  own = glm::transpose(blade.segment_from_part) * own * blade.segment_from_part;
  const double l = heavy.fins->length_m, w = heavy.fins->width_m;
  EXPECT_NEAR(own[0][0], w * w / 12.0, 1e-9);
  EXPECT_NEAR(own[1][1], (l * l + w * w) / 12.0, 1e-9);
  EXPECT_NEAR(own[2][2], l * l / 12.0, 1e-9);
}

}  // namespace
}  // namespace neritic::diver
