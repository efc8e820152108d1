// Extremes of a dive: limbs at 10 m/s, steps of a second, upside down, 300 m to the surface
// at once, tanks of 0 and 350 bar, buttons gone wild, sensors that jump, numbers that are none.
// Energy stays bounded, nothing that leaves is not finite, and afterwards everything is as it
// should be.
#include <gtest/gtest.h>

#include <limits>

#include "diver/swimmer.hpp"
#include "engine/sim/fields.hpp"
#include "tests/diver/bodies.hpp"

namespace neritic::diver {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
const Quat kLevel(1.0, 0.0, 0.0, 0.0);

HumanState start_in(const Body& body, double depth_m) {
  return start_at(body, {0.0, 0.0, depth_m}, kLevel, rotations_of(streamlined(body)));
}

double energy_of(const Body& body, const HumanState& state) {
  return kinetic_energy(body, state.root, state.limbs, gas_load(body, state));
}

// Comes to rest, and, put back in trim, swims as one who was never disturbed.
void expect_recovers(const Body& body, HumanState state) {
  HumanInputs inputs;
  inputs.joints = rotations_of(streamlined(body));
  for (int i = 0; i < 15 * 240; ++i) {
    state.root.position_ned_m.z = 20.0;
    state = step(body, state, inputs, 1.0 / 240.0);
  }
  ASSERT_TRUE(sim::all_finite(state));
  EXPECT_LT(glm::length(state.root.velocity.linear()), 1.0);
  EXPECT_LT(glm::length(state.root.velocity.angular()), 0.5);
  ASSERT_TRUE(teleport(state, {0.0, 0.0, 20.0}, kLevel));
  state.life.jacket_moles = start_in(body, 20.0).life.jacket_moles;
  SwimmerState swimmer;
  const SwimGoal goal{{1000.0, 0.0, 20.0}, 0.45};
  for (int i = 0; i < 30 * 240; ++i) {
    if (i % 4 == 0) swim(body, SwimmerSettings{}, goal, state, swimmer, 1.0 / 60.0, inputs);
    state = step(body, state, inputs, 1.0 / 240.0);
  }
  EXPECT_GT(state.root.position_ned_m.x, 8.0);
}

// Arms and legs thrashing so that hands and fins move at 10 m/s.
JointRotations thrashing(double t) {
  JointAngles a{};
  for (std::size_t i = 0; i < kJoints; ++i)
    for (int axis = 0; axis < 3; ++axis)
      a[i][axis] = 0.9 * std::sin(2.0 * kPi * (2.0 + 0.1 * static_cast<double>(i)) * t + axis + i);
  return rotations_of(a);
}

TEST(DiverExtremes, LimbsAtTenMetresASecondAtAnyStepStayBounded) {
  const Body body = body_with(Gear{});
  for (const double dt : {1.0 / 240.0, 1.0 / 60.0, 0.1, 0.3, 1.0}) {
    HumanState state = start_in(body, 20.0);
    HumanInputs inputs;
    double most_j = 0.0, fastest = 0.0;
    for (double t = 0.0; t < 20.0; t += dt) {
      inputs.joints = thrashing(t);
      inputs.current_ned_m_s = {2.0, -1.0, 0.5};
      state = step(body, state, inputs, dt);
      ASSERT_TRUE(sim::all_finite(state)) << dt;
      most_j = std::max(most_j, energy_of(body, state));
      for (const SegmentPose& p : posture_of(body, state.limbs.rotation, state.limbs.rate))
        fastest = std::max(fastest, glm::length(p.velocity_m_s));
    }
    EXPECT_LT(most_j, 2e4) << dt;  // the limbs' own at 10 m/s
    if (dt < 0.02) {
      EXPECT_GT(fastest, 5.0) << dt;
    }
    ASSERT_NO_FATAL_FAILURE(expect_recovers(body, state)) << dt;
  }
}

TEST(DiverExtremes, JumpingSensorsAreFollowedAtALimbsPace) {
  const Body body = body_with(Gear{});
  HumanState state = start_in(body, 20.0);
  HumanInputs inputs;
  HumanDraws draws(3);
  double fastest = 0.0, most_j = 0.0;
  for (int i = 0; i < 2400; ++i) {
    if (i % 10 == 0)  // anywhere, 24 times a second
      for (Quat& q : inputs.joints) q = draws.attitude();
    state = step(body, state, inputs, 1.0 / 240.0);
    ASSERT_TRUE(sim::all_finite(state));
    for (const Vec3& rate : state.limbs.rate) fastest = std::max(fastest, glm::length(rate));
    most_j = std::max(most_j, energy_of(body, state));
  }
  EXPECT_GT(state.far_joints, 1000u);
  EXPECT_LT(fastest, 32.0);
  EXPECT_LT(most_j, 5e4);
  expect_recovers(body, state);
}

TEST(DiverExtremes, UpsideDownTheGasGoesToTheFeetAndTheDiverComesBack) {
  const Body body = body_with(Gear{});
  HumanState state = start_at(body, {0.0, 0.0, 15.0}, glm::angleAxis(kPi, Vec3(1, 0, 0)));
  HumanInputs inputs;
  inputs.buttons = kInflate;
  for (int i = 0; i < 20 * 240; ++i) {
    state = step(body, state, inputs, 1.0 / 240.0);
    ASSERT_TRUE(sim::all_finite(state));
  }
  expect_recovers(body, state);
}

TEST(DiverExtremes, FromThreeHundredMetresToTheSurfaceAtOnce) {
  const Body body = body_with(Gear{});
  for (const double dt : {1.0 / 240.0, 0.2, 1.0}) {
    HumanState state = start_in(body, 300.0);
    EXPECT_GT(state.life.jacket_moles, 1.0);
    HumanInputs inputs;
    inputs.hold_breath = 1;
    state = step(body, state, inputs, dt);
    ASSERT_TRUE(teleport(state, {0.0, 0.0, 0.2}, kLevel));
    double fastest = 0.0;
    for (double t = 0.0; t < 20.0; t += dt) {
      state = step(body, state, inputs, dt);
      ASSERT_TRUE(sim::all_finite(state));
      fastest = std::max(fastest, glm::length(state.root.velocity.linear()));
    }
    EXPECT_LT(fastest, 5.0) << dt;
    EXPECT_GT(state.life.lungs.overstretched_s, 0.0);
    EXPECT_LE(state.life.lungs.volume_m3, body.lungs.total_m3);
    const JacketGas gas = jacket_gas(body, state.life.jacket_moles, thorax_place(body, state));
    EXPECT_LT(gas.pressure_pa - gas.ambient_pa, 0.3e5);
    ASSERT_NO_FATAL_FAILURE(expect_recovers(body, state)) << dt;
  }
}

TEST(DiverExtremes, TanksOfNothingAndOf350Bar) {
  for (const double bar : {0.0, 350.0}) {
    Gear gear;
    gear.tanks[0].pressure_pa = bar * 1e5;
    const Body body = body_with(gear);
    for (const double dt : {1.0 / 240.0, 1.0}) {
      HumanState state = start_in(body, 30.0);
      HumanInputs inputs;
      inputs.buttons = kInflate;
      inputs.other_power_w = 500.0;
      for (double t = 0.0; t < 60.0; t += dt) {
        state = step(body, state, inputs, dt);
        ASSERT_TRUE(sim::all_finite(state));
        ASSERT_GE(state.life.tanks.moles[0], 0.0);
      }
      const GasReading gas = read_gas(body, state);
      if (bar == 0.0) {
        EXPECT_EQ(state.life.lungs.breathed_moles, 0.0);
        EXPECT_GT(state.life.lungs.starved_s, 5.0);
        EXPECT_GT(state.life.lungs.unfed_s, 50.0);
        EXPECT_EQ(gas.ventilation_l_min, 0.0);
        EXPECT_EQ(gas.tank_pa, 0.0);
        EXPECT_EQ(gas.remaining_s, 0.0);
      } else {
        EXPECT_LT(gas.tank_pa, 350e5);
        EXPECT_GT(gas.tank_pa, 300e5);
      }
    }
  }
}

// A hundred bar around, and a tank of oxygen: breathed for what it is, told by the risk proxies.
TEST(DiverExtremes, AKilometreDownOnPureOxygen) {
  Gear gear;
  gear.tanks[0].mix = {1.0, 0.0};
  const Body body = body_with(gear);
  for (const double dt : {1.0 / 240.0, 1.0}) {
    HumanState state = start_in(body, 1000.0);
    HumanInputs inputs;
    inputs.joints = rotations_of(streamlined(body));
    inputs.buttons = kInflate;
    for (double t = 0.0; t < 60.0; t += dt) {
      state = step(body, state, inputs, dt);
      state.root.position_ned_m.z = 1000.0;
      ASSERT_TRUE(sim::all_finite(state)) << dt;
    }
    EXPECT_GE(state.life.tanks.moles[0], 0.0);
    EXPECT_EQ(state.life.vitals.risk.gas_density, RiskLevel::kSevere);
    EXPECT_EQ(state.life.vitals.risk.refused, 0u);
    ASSERT_NO_FATAL_FAILURE(expect_recovers(body, state)) << dt;
  }
}

TEST(DiverExtremes, ABurstOfButtonPresses) {
  const Body body = body_with(Gear{});
  HumanState state = start_in(body, 15.0);
  HumanInputs inputs;
  HumanDraws draws(8);
  for (int i = 0; i < 60 * 240; ++i) {
    inputs.buttons = static_cast<std::uint64_t>(draws.uniform(0.0, 8.0));
    inputs.hold_breath = static_cast<std::uint64_t>(draws.uniform(0.0, 2.0));
    inputs.tank = static_cast<std::uint64_t>(draws.uniform(0.0, 4.0));
    state = step(body, state, inputs, 1.0 / 240.0);
    ASSERT_TRUE(sim::all_finite(state));
    ASSERT_GE(state.life.jacket_moles, 0.0);
  }
  EXPECT_EQ(state.refused_inputs, 0u);
  expect_recovers(body, state);
}

TEST(DiverExtremes, WhatIsNoNumberIsRefusedCountedAndHeld) {
  const Body body = body_with(Gear{});
  for (const double bad : {kNotANumber, kInf, -kInf, 1e300}) {
    HumanState state = start_in(body, 15.0);
    HumanInputs good;
    good.joints = rotations_of(streamlined(body));
    good.current_ned_m_s = {0.2, 0.0, 0.0};
    good.ventilation_l_min = 20.0;
    state = step(body, state, good, 1.0 / 240.0);
    ASSERT_EQ(state.refused_inputs, 0u);
    HumanInputs inputs = good;
    inputs.joints[4].x = bad;
    inputs.joints[9] = Quat(bad, bad, bad, bad);
    inputs.current_ned_m_s.y = bad;
    inputs.other_power_w = bad;
    inputs.ventilation_l_min = bad;
    inputs.breath_bias_m3 = bad;
    inputs.buttons = 77;
    inputs.hold_breath = 2;
    inputs.tank = 9;
    const HumanState held = step(body, state, inputs, 1.0 / 240.0);
    EXPECT_EQ(held.refused_inputs, 9u) << bad;
    // As if the good ones had come again.
    HumanState as_good = step(body, state, good, 1.0 / 240.0);
    as_good.refused_inputs = held.refused_inputs;
    EXPECT_TRUE(sim::same_bits(held, as_good)) << bad;
  }
}

TEST(DiverExtremes, StepsThatAreNoneMoveNothing) {
  const Body body = body_with(Gear{});
  const HumanState state = start_in(body, 15.0);
  for (const double dt : {0.0, -1.0, kNotANumber, kInf, 11.0}) {
    const HumanState next = step(body, state, state.held, dt);
    EXPECT_EQ(next.refused_inputs, 1u);
    EXPECT_EQ(next.root.position_ned_m, state.root.position_ned_m);
  }
  HumanState moved = state;
  EXPECT_FALSE(teleport(moved, {kNotANumber, 0.0, 0.0}, kLevel));
  EXPECT_FALSE(teleport(moved, {0.0, 0.0, 0.0}, Quat(0.0, 0.0, 0.0, 0.0)));
  EXPECT_TRUE(sim::same_bits(moved, state));
}

TEST(DiverExtremes, LongStepsEndWhereShortOnesDo) {
  // Adrift in a current with nothing to do, a second at a time.
  const Body body = body_with(Gear{});
  HumanInputs inputs;
  inputs.joints = rotations_of(streamlined(body));
  inputs.current_ned_m_s = {0.5, 0.0, 0.0};
  HumanState fine = start_in(body, 20.0), coarse = fine;
  for (int i = 0; i < 10 * 240; ++i) fine = step(body, fine, inputs, 1.0 / 240.0);
  for (int i = 0; i < 10; ++i) coarse = step(body, coarse, inputs, 1.0);
  EXPECT_LT(glm::length(fine.root.position_ned_m - coarse.root.position_ned_m), 0.05);
}

TEST(DiverExtremes, RandomBodiesInRandomTroubleStayFinite) {
  for (std::uint64_t index = 0; index < 60; ++index) {
    HumanDraws draws(500 + index);
    BodyParameters p;
    p.build.sex = index % 2 ? Sex::kFemale : Sex::kMale;
    p.build.height_m = draws.uniform(1.45, 2.1);
    p.build.mass_kg = 42.0 * p.build.height_m * draws.uniform(0.7, 1.6);
    p.gear.suit->thickness_m = draws.uniform(0.0, 0.012);
    p.gear.fins->length_m = draws.uniform(0.05, 1.2);
    p.gear.fins->width_m = draws.uniform(0.05, 0.9);
    p.gear.fins->mass_kg = draws.uniform(0.1, 8.0);
    p.gear.tanks.resize(1 + index % 4);
    p.water_kg_m3 = draws.uniform(950.0, 1250.0);
    p.model = index % 3 == 0 ? Model::kPlanar : Model::kFull;
    p.strips_a_segment = 1 + static_cast<int>(index % 8);
    const Body body = make_body(p).value();
    HumanState state = start_at(body, draws.vec3(40.0), draws.attitude());
    const double dt = std::exp(draws.uniform(std::log(1e-3), std::log(1.0)));
    HumanInputs inputs;
    for (int i = 0; i < 200; ++i) {
      for (Quat& q : inputs.joints) q = draws.attitude();
      inputs.current_ned_m_s = draws.vec3(5.0);
      inputs.buttons = static_cast<std::uint64_t>(draws.uniform(0.0, 8.0));
      state = step(body, state, inputs, dt);
      ASSERT_TRUE(sim::all_finite(state)) << index;
      ASSERT_LT(glm::length(state.root.velocity.linear()), 60.0) << index;
    }
    inputs.joints = straight_joints();
    inputs.current_ned_m_s = Vec3(0.0);
    inputs.buttons = 0;
    teleport(state, {0.0, 0.0, 50.0}, kLevel);
    for (int i = 0; i < 600; ++i) state = step(body, state, inputs, 1.0 / 60.0);
    EXPECT_LT(glm::length(state.root.velocity.linear()), 3.0) << index;
  }
}

}  // namespace
}  // namespace neritic::diver
