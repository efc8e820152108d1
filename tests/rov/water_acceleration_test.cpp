// Vehicles in water that speeds up, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rov/step.hpp"
#include "tests/rov/random_vehicle.hpp"

namespace neritic::rov {
namespace {

constexpr double kStep_s = 1.0 / 240.0;

// Water at a place: what a current's sample says of it.
struct Water {
  Vec3 velocity_m_s{0.0}, rate_m_s2{0.0};
  Mat3 gradient_per_s{0.0};
};

Inputs in_water(const Water& water, const State& state) {
  Inputs inputs;
  inputs.current_ned_m_s = water.velocity_m_s;
  inputs.current_change_ned_m_s2 =
      water.rate_m_s2 + water.gradient_per_s * (state.attitude * state.velocity.linear());
  inputs.water_acceleration_ned_m_s2 = water.rate_m_s2 + water.gradient_per_s * water.velocity_m_s;
  return inputs;
}

// The BlueROV2 Heavy, weightless in water about its own origin.
VehicleParameters drifter() {
  VehicleParameters p = bluerov2_heavy();
  p.buoyancy_n = p.weight_n;
  p.gravity_centre_m = p.buoyancy_centre_m = Vec3(0.0);
  return p;
}

// All of the water gathers speed evenly: what has its density goes along, in any attitude, though
// its added mass differs along each axis; by every integrator and to rounding.
TEST(RovWaterAcceleration, ANeutralVehicleMovesWithWaterThatGathersSpeed) {
  const Vehicle vehicle = make_vehicle(drifter()).value();
  const Vec3 a(0.3, -0.2, 0.1);
  for (const Integrator by : {Integrator::kSemiImplicit, Integrator::kRk4, Integrator::kGuarded}) {
    State state;
    state.attitude = glm::normalize(Quat(0.8, 0.3, -0.4, 0.2));
    const Quat attitude = state.attitude;
    for (int i = 0; i < 2400; ++i)
      state = step(vehicle, state, in_water({a * (i * kStep_s), a, {}}, state), kStep_s, by);
    EXPECT_LT(glm::length(state.attitude * state.velocity.linear() - 10.0 * a), 1e-9);
    EXPECT_LT(glm::length(state.velocity.angular()), 1e-9);
    EXPECT_LT(glm::length(state.attitude - attitude), 1e-9);
    // Euler's end-of-step velocity leads by half a step.
    const double lead_s = by == Integrator::kSemiImplicit ? kStep_s : 0.0;
    EXPECT_LT(glm::length(state.position_ned_m - a * (0.5 * 10.0 * (10.0 + lead_s))), 1e-8);
  }
}

// A sphere without drag in water that gathers speed: (rho V + M_A) / (m + M_A) of the water's
// acceleration, 3 / (1 + 2 s) at s times its density with M_A = rho V / 2 (Lamb 1932, art. 92).
TEST(RovWaterAcceleration, ASphereTakesItsShareOfTheWatersAcceleration) {
  for (const double density : {0.1, 0.5, 1.0, 2.7, 7.8}) {
    VehicleParameters p;
    p.mass_kg = 10.0 * density;
    p.inertia_kg_m2 = Mat3(0.1 * p.mass_kg);
    p.weight_n = 9.82 * p.mass_kg;
    p.buoyancy_n = 98.2;
    for (std::size_t i = 0; i < 3; ++i) p.added_mass(i, i) = 5.0;
    const Vehicle vehicle = make_vehicle(p).value();
    EXPECT_NEAR(vehicle.displaced_kg, 10.0, 1e-12);
    const Vec3 a(0.4, -0.3, 0.0);
    State state;
    state.attitude = glm::normalize(Quat(0.8, 0.3, -0.4, 0.2));
    for (int i = 0; i < 1200; ++i)
      state = step(vehicle, state, in_water({a * (i * kStep_s), a, {}}, state), kStep_s);
    const Vec3 velocity = state.attitude * state.velocity.linear();
    EXPECT_LT(glm::length(Vec3(velocity.x, velocity.y, 0.0) - 15.0 / (1.0 + 2.0 * density) * a),
              1e-9)
        << density;
  }
}

// Between converging walls of water: u = k (x, -y) is (Du/Dt) = k^2 (x, y), and what drifts follows
// x e^(kt), y e^(-kt). To second order in the step, where the water half way through it is taken.
TEST(RovWaterAcceleration, ANeutralVehicleFollowsTheWatersPathThroughAStrain) {
  VehicleParameters p = drifter();
  p.added_mass = diagonal({{6.36, 6.36, 6.36, 0.189, 0.135, 0.222}});  // no Munk moment
  const Vehicle vehicle = make_vehicle(p).value();
  const double k = 0.5;
  const auto miss_m = [&](double dt_s) {
    State state;
    state.position_ned_m = {0.5, 4.0, 0.0};
    state.velocity = {{0.5 * k, -4.0 * k, 0, 0, 0, 0}};
    for (int i = 0; i < std::lround(4.0 / dt_s); ++i) {
      const Vec3 half_way =
          state.position_ned_m + 0.5 * dt_s * (state.attitude * state.velocity.linear());
      Water water;
      water.velocity_m_s = k * Vec3(half_way.x, -half_way.y, 0.0);
      water.gradient_per_s[0][0] = k;
      water.gradient_per_s[1][1] = -k;
      Inputs inputs = in_water(water, state);
      inputs.current_ned_m_s -= 0.5 * dt_s * inputs.current_change_ned_m_s2;
      state = step(vehicle, state, inputs, dt_s);
    }
    return glm::length(state.position_ned_m -
                       Vec3(0.5 * std::exp(4.0 * k), 4.0 * std::exp(-4.0 * k), 0.0));
  };
  const double coarse_m = miss_m(1.0 / 60.0), fine_m = miss_m(1.0 / 120.0);
  EXPECT_LT(fine_m, 1e-4);
  EXPECT_NEAR(coarse_m / fine_m, 4.0, 0.2);
}

// Accelerating water is as gravity that leans: buoyancy points along g - a, and what hangs below
// its centre of buoyancy comes to rest along it.
TEST(RovWaterAcceleration, ItHangsAlongWhatGravityAndTheWaterTogetherAre) {
  VehicleParameters p = bluerov2_heavy();
  p.buoyancy_n = p.weight_n;
  p.linear_damping = diagonal({{13.7, 13.7, 33.0, 1.0, 1.0, 1.0}});
  const Vehicle vehicle = make_vehicle(p).value();
  State state;
  for (int i = 0; i < 60 * 240; ++i)
    state = step(vehicle, state, in_water({{0.5 * i * kStep_s, 0, 0}, {0.5, 0, 0}, {}}, state),
                 kStep_s);
  const Vec3 down = state.attitude * Vec3(0, 0, 1);
  EXPECT_LT(glm::length(down - glm::normalize(Vec3(-0.5, 0.0, 9.82))), 1e-4);
}

// The rate that sensors read is that of the motion.
TEST(RovWaterAcceleration, DerivativeIsTheRateOfTheMotion) {
  const Vehicle vehicle = heavy_vehicle();
  Draws draws(9);
  for (int n = 0; n < 20; ++n) {
    const State state = random_state(draws, 0.5);
    Inputs inputs;
    inputs.current_ned_m_s = draws.vec3(0.5);
    inputs.current_change_ned_m_s2 = draws.vec3(1.0);
    inputs.water_acceleration_ned_m_s2 = draws.vec3(1.0);
    const double h = 1e-6;
    const Vec6 rate = (1.0 / h) * (step(vehicle, state, inputs, h).velocity - state.velocity);
    const Vec6 told = derivative(vehicle, state, inputs).velocity;
    EXPECT_LT(glm::length(rate.linear() - told.linear()), 2e-4);
    EXPECT_LT(glm::length(rate.angular() - told.angular()), 2e-4);
  }
}

TEST(RovWaterAcceleration, WhatIsNoAccelerationIsRefusedAndTheLastHeld) {
  const Vehicle vehicle = heavy_vehicle();
  Inputs good;
  good.water_acceleration_ned_m_s2 = {0.2, 0.0, 0.0};
  good.current_change_ned_m_s2 = {0.1, 0.0, 0.0};
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e3}) {
    const State state = step(vehicle, {}, good, kStep_s);
    Inputs bad = good;
    bad.water_acceleration_ned_m_s2.z = bad.current_change_ned_m_s2.y = wrong;
    const State after = step(vehicle, state, bad, kStep_s);
    EXPECT_EQ(after.refused_inputs, 2u);
    EXPECT_EQ(after.velocity, step(vehicle, state, good, kStep_s).velocity);
  }
}

}  // namespace
}  // namespace neritic::rov
