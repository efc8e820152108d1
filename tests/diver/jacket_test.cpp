// The jacket against Boyle's law and hand calculations; its valves by where they are; divers that
// hover, rise and cannot stop rising.
#include <gtest/gtest.h>

#include "tests/diver/bodies.hpp"

namespace neritic::diver {
namespace {

// Lying, face down.
ThoraxPlace lying(double depth_m) {
  return {{0.0, 0.0, -1.0}, depth_m};
}
ThoraxPlace standing(double depth_m) {
  return {{1.0, 0.0, 0.0}, depth_m};
}
ThoraxPlace on_the_head(double depth_m) {
  return {{-1.0, 0.0, 0.0}, depth_m};
}

TEST(Jacket, GasFollowsBoylesLaw) {
  const Body body = body_with(Gear{});
  // The gas's lower side lies so far above the thorax.
  const double moles = jacket_moles(body, 5e-3, lying(10.0));
  const JacketGas at10 = jacket_gas(body, moles, lying(10.0));
  EXPECT_NEAR(at10.volume_m3, 5e-3, 1e-7);
  const double below_m = 10.0 + at10.bottom_m;  // so that the gas is at 10 m itself
  const double exact = jacket_moles(body, 5e-3, lying(below_m));
  EXPECT_NEAR(jacket_gas(body, exact, lying(below_m + 10.0)).volume_m3, 3.3378e-3, 3e-6);
  EXPECT_NEAR(jacket_gas(body, exact, lying(below_m - 10.0)).volume_m3, 9.960e-3, 5e-5);
  EXPECT_NEAR(1e-3 * body.water_kg_m3 * kGravity_m_s2, 10.0518, 1e-3);  // N a litre
}

TEST(Jacket, FiveLitresAtTenMetresRunAwayWithTwoAndAHalfNewtonsAMetre) {
  const Body body = body_with(Gear{});
  const double moles = jacket_moles(body, 5e-3, lying(10.0));
  const auto lift_n = [&](double depth_m) {
    return body.water_kg_m3 * kGravity_m_s2 * jacket_gas(body, moles, lying(depth_m)).volume_m3;
  };
  EXPECT_NEAR((lift_n(10.01) - lift_n(9.99)) / 0.02, -2.503, 0.03);
}

TEST(Jacket, GasLiesAtItsHighestPlace) {
  const Body body = body_with(Gear{});
  const Jacket& j = body.jacket;
  const double moles = jacket_moles(body, 2e-3, lying(10.0));
  const JacketGas back = jacket_gas(body, moles, lying(10.0));
  const JacketGas up = jacket_gas(body, moles, standing(10.0));
  const JacketGas down = jacket_gas(body, moles, on_the_head(10.0));
  EXPECT_LT(back.centre_m.z, j.centre_m.z - 0.4 * j.half_axes_m.z);
  EXPECT_NEAR(back.centre_m.x, j.centre_m.x, 1e-12);
  EXPECT_GT(up.centre_m.x, j.centre_m.x + 0.4 * j.half_axes_m.x);
  EXPECT_LT(down.centre_m.x, j.centre_m.x - 0.4 * j.half_axes_m.x);
  // Full, it is everywhere.
  const JacketGas full =
      jacket_gas(body, jacket_moles(body, j.capacity_m3, standing(10.0)), standing(10.0));
  EXPECT_LT(glm::length(full.centre_m - j.centre_m), 1e-6);
  EXPECT_NEAR(full.bottom_m, glm::dot(standing(0).up, j.centre_m) - j.half_axes_m.x, 1e-6);
}

double pressed(const Body& body, std::uint64_t buttons, const ThoraxPlace& place, double start_m3,
               double seconds, TankState& tanks) {
  double moles = jacket_moles(body, start_m3, place);
  for (int i = 0; i < static_cast<int>(seconds * 240); ++i)
    step_jacket(body, moles, tanks, buttons, place, 1.0 / 240.0);
  return jacket_gas(body, moles, place).volume_m3;
}

// On the head the gas lies at the valve low on the back: its cord lets it out, the hose's button
// does not.
TEST(Jacket, DumpsThroughTheHigherValve) {
  const Body body = body_with(Gear{});
  TankState tanks = full_tanks(body);
  for (const ThoraxPlace& place : {standing(10.0), on_the_head(10.0)}) {
    EXPECT_TRUE(gas_at_dump(body, jacket_moles(body, 5e-3, place), place));
    EXPECT_LT(pressed(body, kDump, place, 5e-3, 5.0, tanks), 1.5e-3);
  }
  EXPECT_NEAR(pressed(body, kDeflate, on_the_head(10.0), 5e-3, 5.0, tanks), 5e-3, 1e-6);
  EXPECT_FALSE(gas_at_dump(body, 0.0, standing(10.0)));
}

TEST(Jacket, ButtonsFillAndEmptyItAsTheyDo) {
  const Body body = body_with(Gear{});
  const TankState full = full_tanks(body);
  TankState tanks = full;
  // 100 litres of 1 bar a minute at the surface, about half of that volume at 10 m.
  EXPECT_NEAR(pressed(body, kInflate, standing(0.3), 0.0, 3.0, tanks), 5e-3, 0.5e-3);
  tanks = full;
  const double at10 = pressed(body, kInflate, standing(10.0), 0.0, 3.0, tanks);
  EXPECT_NEAR(at10, 2.7e-3, 0.4e-3);
  // The jacket's gain is the tank's loss.
  const double moles = jacket_moles(body, at10, standing(10.0));
  EXPECT_NEAR(full.moles[0] - tanks.moles[0], moles, 1e-4 * moles);
  EXPECT_LT(pressed(body, kDeflate, standing(10.0), 5e-3, 1.0, tanks), 3.5e-3);
  EXPECT_GT(pressed(body, kDeflate, standing(10.0), 5e-3, 1.0, tanks), 1.0e-3);
  EXPECT_LT(pressed(body, kDump, standing(10.0), 5e-3, 1.0, tanks), 2.0e-3);
  EXPECT_NEAR(pressed(body, 0, standing(10.0), 5e-3, 10.0, tanks), 5e-3, 1e-6);
  EXPECT_LT(pressed(body, kInflate | kDump, standing(10.0), 5e-3, 3.0, tanks), 1e-3);
}

TEST(Jacket, GasLeavesOnlyWhereItReachesTheValve) {
  const Body body = body_with(Gear{});
  TankState tanks = full_tanks(body);
  // On the head the shoulders, where the hose is, are below the gas.
  EXPECT_NEAR(pressed(body, kDeflate, on_the_head(10.0), 4e-3, 5.0, tanks), 4e-3, 1e-6);
  // Head up by 30 degrees it goes.
  const ThoraxPlace head_up{{0.5, 0.0, -std::sqrt(0.75)}, 10.0};
  EXPECT_LT(pressed(body, kDump, head_up, 4e-3, 5.0, tanks), 1.5e-3);
}

TEST(Jacket, AnEmptyTankFillsNothing) {
  Gear gear;
  gear.tanks[0].pressure_pa = 0.0;
  const Body body = body_with(gear);
  TankState tanks = full_tanks(body);
  EXPECT_EQ(pressed(body, kInflate, standing(10.0), 0.0, 3.0, tanks), 0.0);
  EXPECT_EQ(tanks.moles[0], 0.0);
}

TEST(Jacket, TheReliefValveHoldsItsPressure) {
  const Body body = body_with(Gear{});
  TankState tanks = full_tanks(body);
  double moles = 0.0;
  for (int i = 0; i < 60 * 240; ++i)
    step_jacket(body, moles, tanks, kInflate, standing(5.0), 1.0 / 240.0);
  const JacketGas gas = jacket_gas(body, moles, standing(5.0));
  EXPECT_EQ(gas.volume_m3, body.jacket.capacity_m3);
  EXPECT_GT(gas.pressure_pa - gas.ambient_pa, 8e3);
  EXPECT_LT(gas.pressure_pa - gas.ambient_pa, 20e3);  // 0.2 bar
  // A jacket filled at 30 m and brought up at once bursts nothing.
  moles = jacket_moles(body, body.jacket.capacity_m3, standing(30.0));
  for (int i = 0; i < 10 * 240; ++i) step_jacket(body, moles, tanks, 0, standing(2.0), 1.0 / 240.0);
  const JacketGas up = jacket_gas(body, moles, standing(2.0));
  EXPECT_LT(up.pressure_pa - up.ambient_pa, 20e3);
}

TEST(Jacket, FlowsAreThoseOfNozzles) {
  // Choked: 0.04042 A p / sqrt(T), in SI (Shapiro 1953, eq. 4.17, of air with argon).
  const double kg_s = orifice_moles_s(kAir, 1e-4, 1e5, 1e4) * molar_mass(kAir);
  EXPECT_NEAR(kg_s, 0.04041874 * 1e5 * 1e-4 / std::sqrt(293.15), 1e-4);
  // Hardly any pressure: A sqrt(2 rho dp).
  const double slow_kg_s = orifice_moles_s(kAir, 1e-4, 1e5 + 100.0, 1e5) * molar_mass(kAir);
  const double rho = 1e5 * molar_mass(kAir) / (kGasConstant * kTankTemperature_k);
  EXPECT_NEAR(slow_kg_s, 1e-4 * std::sqrt(2.0 * rho * 100.0), 2e-3 * slow_kg_s);
  EXPECT_EQ(orifice_moles_s(kAir, 1e-4, 1e5, 1e5), 0.0);
}

HumanState hover_at(const Body& body, double depth_m, double seconds, HumanInputs inputs = {},
                    double* farthest_m = nullptr) {
  HumanState state = start_at(body, {0.0, 0.0, depth_m}, Quat(1.0, 0.0, 0.0, 0.0),
                              rotations_of(streamlined(body)));
  inputs.joints = state.held.joints;
  for (int i = 0; i < static_cast<int>(seconds * 240); ++i) {
    state = step(body, state, inputs, 1.0 / 240.0);
    if (farthest_m)
      *farthest_m = std::max(*farthest_m, std::abs(state.root.position_ned_m.z - depth_m));
  }
  return state;
}

TEST(Buoyancy, AWeightedDiverAtRestHovers) {
  for (const double depth_m : {5.0, 10.0, 20.0}) {
    double farthest_m = 0.0;
    const HumanState state = hover_at(body_with(Gear{}), depth_m, 12.0, {}, &farthest_m);
    EXPECT_LT(farthest_m, 0.5) << depth_m;
    EXPECT_LT(std::abs(net_weight_n(body_with(Gear{}), state)), 8.0) << depth_m;  // a breath
  }
}

TEST(Buoyancy, AHeldFullBreathLiftsAndAHeldEmptyOneSinks) {
  const Body body = body_with(Gear{});
  const auto held_at = [&](double phase_rad) {
    HumanState state = start_at(body, {0.0, 0.0, 10.0}, Quat(1.0, 0.0, 0.0, 0.0));
    HumanInputs inputs;
    while (std::abs(std::remainder(state.life.lungs.phase_rad - phase_rad, 2.0 * kPi)) > 0.02)
      state = step(body, state, inputs, 1.0 / 240.0);
    const double start_m = state.root.position_ned_m.z;
    inputs.hold_breath = 1;
    for (int i = 0; i < 10 * 240; ++i) state = step(body, state, inputs, 1.0 / 240.0);
    return state.root.position_ned_m.z - start_m;
  };
  EXPECT_LT(held_at(kPi), -0.3);
  EXPECT_GT(held_at(0.0), 0.3);
}

TEST(Buoyancy, AnAscentOnceBegunRunsAway) {
  const Body body = body_with(Gear{});
  HumanInputs inputs;
  HumanState state = start_at(body, {0.0, 0.0, 20.0}, glm::angleAxis(0.5 * kPi, Vec3(0, 1, 0)));
  inputs.buttons = kInflate;
  for (int i = 0; i < 3 * 240; ++i) state = step(body, state, inputs, 1.0 / 240.0);
  inputs.buttons = 0;
  const auto rate_at = [&](double depth_m) {
    for (int i = 0; i < 300 * 240 && state.root.position_ned_m.z > depth_m; ++i)
      state = step(body, state, inputs, 1.0 / 240.0);
    return -(state.root.attitude * state.root.velocity.linear()).z;
  };
  const double at15 = rate_at(15.0), at10 = rate_at(10.0), at3 = rate_at(3.0);
  EXPECT_GT(at10, 1.05 * at15);
  EXPECT_GT(at3, 1.2 * at10);
  EXPECT_GT(at3 * 60.0, 18.0);  // m/min: an alarm
  EXPECT_LT(at3, 1.5);
  // It ends at the surface, upright, the jacket no more than full.
  for (int i = 0; i < 60 * 240; ++i) state = step(body, state, inputs, 1.0 / 240.0);
  EXPECT_LT(state.root.position_ned_m.z, 1.5);
  EXPECT_GT(state.root.position_ned_m.z, -0.8);
  EXPECT_LT(glm::length(state.root.velocity.linear()), 0.4);
}

}  // namespace
}  // namespace neritic::diver
