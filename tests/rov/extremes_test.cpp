// Extremes of a vehicle: steps of a second, ten kilonewton, a thousandth of the mass, five
// metres a second of current, jumps, 100 km, inputs that are no numbers. Energy stays bounded,
// nothing that leaves is not finite, and afterwards it flies as before.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "rov/bluerov2.hpp"
#include "rov/closed_loop.hpp"
#include "rov/guidance.hpp"
#include "tests/rov/random_vehicle.hpp"

namespace neritic::rov {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// Comes to rest when everything stops.
void expect_recovers(const Vehicle& vehicle, State state, double dt_s) {
  for (double t = 0.0; t < 60.0; t += dt_s) state = step(vehicle, state, {}, dt_s);
  ASSERT_TRUE(all_finite(state));
  EXPECT_LT(glm::length(state.velocity.linear()), 1.0);
  EXPECT_LT(glm::length(state.velocity.angular()), 1.0);
}

TEST(RovExtremes, StepsOfASecondUnderTenKilonewtonStayBounded) {
  const Vehicle vehicle = heavy_vehicle();
  for (const double dt : {1.0 / 240.0, 0.01, 0.05, 0.3, 1.0})
    for (std::uint64_t index = 0; index < 8; ++index) {
      Draws draws(index);
      State state = random_state(draws, 1.0);
      Inputs inputs;
      inputs.wrench = 1e4 * vec6(draws.attitude() * Vec3(1, 0, 0), 0.2 * draws.vec3(1.0));
      inputs.current_ned_m_s = 5.0 * (draws.attitude() * Vec3(1, 0, 0));
      for (std::size_t i = 0; i < 8; ++i) inputs.thruster_n[i] = draws.uniform(-1e4, 1e4);
      for (double t = 0.0; t < 10.0; t += dt) {
        state = step(vehicle, state, inputs, dt);
        ASSERT_TRUE(all_finite(state)) << dt << " " << index;
        // Terminal velocities: sqrt(1.2e4 N / 141), sqrt(2.2e3 N m / 0.47), with room for swings.
        const Vec6 nu = through_water(state.attitude, state.velocity, inputs.current_ned_m_s);
        ASSERT_LT(glm::length(nu.linear()), 30.0) << dt << " " << index;
        ASSERT_LT(glm::length(nu.angular()), 150.0) << dt << " " << index;
      }
      ASSERT_NO_FATAL_FAILURE(expect_recovers(vehicle, state, dt)) << dt << " " << index;
    }
}

TEST(RovExtremes, AThousandthOfTheMassUnderTenKilonewton) {
  VehicleParameters p = bluerov2_heavy();
  p.mass_kg /= 1000.0;
  p.inertia_kg_m2 /= 1000.0;
  p.added_mass = 1e-3 * p.added_mass;
  const Vehicle vehicle = make_vehicle(p).value();
  for (const double dt : {1.0 / 240.0, 0.05, 1.0})
    for (std::uint64_t index = 0; index < 10; ++index) {
      Draws draws(index);
      State state = random_state(draws, 1.0);
      Inputs inputs;
      inputs.wrench = 1e4 * vec6(draws.attitude() * Vec3(1, 0, 0), 0.2 * draws.vec3(1.0));
      for (double t = 0.0; t < 5.0; t += dt) {
        state = step(vehicle, state, inputs, dt);
        ASSERT_TRUE(all_finite(state)) << dt << " " << index;
        ASSERT_LT(glm::length(state.velocity.linear()), 30.0) << dt << " " << index;
        ASSERT_LT(glm::length(state.velocity.angular()), 200.0) << dt << " " << index;
      }
    }
}

TEST(RovExtremes, RandomVehiclesNeverGainMoreThanTheirThrustersGive) {
  for (std::uint64_t index = 0; index < 200; ++index) {
    Draws draws(1000 + index);
    const Vehicle vehicle = random_vehicle(draws);
    State state = random_state(draws, draws.scale(0.01, 20.0));
    Inputs inputs;
    const double force = vehicle.mass_kg * draws.scale(0.1, 1000.0);
    inputs.wrench = vec6(force * (draws.attitude() * Vec3(1, 0, 0)), Vec3(0.0));
    const double dt = draws.scale(1e-3, 1.0);
    double energy = kinetic_energy(vehicle, state, Vec3(0.0)), most_given = 0.0;
    for (int i = 0; i < 100; ++i) {
      state = step(vehicle, state, inputs, dt);
      ASSERT_TRUE(all_finite(state)) << index;
      // Power is at most force times speed; without any drag it would be F^2 t^2 / 2 m.
      most_given = 0.5 * std::pow((force + 0.1 * vehicle.weight_n) * (i + 1) * dt, 2.0) /
                   (0.5 * vehicle.mass_kg);
      const double now = kinetic_energy(vehicle, state, Vec3(0.0));
      ASSERT_LT(std::sqrt(now),
                std::sqrt(energy) + std::sqrt(most_given) + std::sqrt(vehicle.weight_n + 1.0))
          << index << ", dt " << dt;
    }
  }
}

TEST(RovExtremes, UpsideDownRightsItself) {
  const Vehicle vehicle = heavy_vehicle();
  for (const double dt : {1.0 / 240.0, 0.1, 1.0}) {
    State state;
    state.attitude = Quat(0.0, 1.0, 0.0, 0.0);  // exactly on its back: a balance, if a poor one
    state.velocity[3] = 1e-6;
    for (double t = 0.0; t < 120.0; t += dt) state = step(vehicle, state, {}, dt);
    EXPECT_LT(std::hypot(state.attitude.x, state.attitude.y), 0.05) << dt;
  }
}

TEST(RovExtremes, AHundredKilometresAwayItMovesAsAtTheOrigin) {
  const Vehicle vehicle = heavy_vehicle();
  State near, far;
  const Vec3 offset(1e5, -1e5, 0.0);
  far.position_ned_m = offset;
  Inputs inputs;
  inputs.wrench = {{40, 10, 5, 0.1, 0.2, 1.0}};
  for (int i = 0; i < 2400; ++i) {
    near = step(vehicle, near, inputs, 1.0 / 240.0);
    far = step(vehicle, far, inputs, 1.0 / 240.0);
  }
  EXPECT_EQ(near.velocity, far.velocity);
  EXPECT_LT(glm::distance(near.position_ned_m + offset, far.position_ned_m), 1e-7);
}

TEST(RovExtremes, InputsThatAreNoNumbersAreRefusedCountedAndHeld) {
  const Vehicle vehicle = heavy_vehicle();
  Inputs good;
  good.wrench = {{5, 0, 0, 0, 0, 0}};
  good.thruster_n = {1, 2, 3, 4, 5, 6, 7, 8};
  good.current_ned_m_s = {0.1, 0.2, 0.0};
  State held = step(vehicle, {}, good, 0.01);
  State expected = step(vehicle, held, good, 0.01);
  ASSERT_EQ(held.refused_inputs, 0u);

  Inputs bad = good;
  bad.wrench[3] = kNan;
  bad.thruster_n[2] = kInf;
  bad.thruster_n[7] = 1e12;
  bad.current_ned_m_s.y = -kInf;
  bad.tether_anchor_ned_m.x = kNan;
  const State after = step(vehicle, held, bad, 0.01);
  EXPECT_EQ(after.refused_inputs, 5u);
  EXPECT_EQ(after.velocity, expected.velocity);
  EXPECT_EQ(after.position_ned_m, expected.position_ned_m);
  EXPECT_EQ(after.held.thruster_n, good.thruster_n);

  for (const double dt : {kNan, kInf, 0.0, -0.1, 11.0}) {
    const State still = step(vehicle, held, good, dt);
    EXPECT_EQ(still.refused_inputs, 1u) << dt;
    EXPECT_EQ(still.velocity, held.velocity) << dt;
  }
}

// A planner's setpoint is an input too: the last good commands are held, and then it flies on.
TEST(RovExtremes, SetpointsThatAreNoNumbersAreRefusedAndItFliesOn) {
  const Vehicle vehicle = heavy_vehicle();
  for (const Saturation saturation : {Saturation::kScale, Saturation::kRedistribute}) {
    ControlGains gains = default_gains();
    gains.saturation = saturation;
    Setpoint home;
    home.position_ned_m = {1.0, -1.0, 10.0};
    State start;
    start.position_ned_m.z = 9.5;
    const LoopRun run = fly(
        vehicle, gains, start,
        [&](const State&, double t_s) {
          Setpoint s = home;
          if (t_s > 1.0 && t_s < 1.5) s.position_ned_m.x = kNan;
          if (t_s > 2.0 && t_s < 2.5) s.attitude.w = kInf;
          if (t_s > 3.0 && t_s < 3.5) s.velocity_ned_m_s.y = kNan;
          if (t_s > 4.0 && t_s < 4.5) s.pilot[2] = kInf;
          return s;
        },
        30.0);
    for (const State& state : run.states) ASSERT_TRUE(all_finite(state));
    EXPECT_GT(run.states.back().refused_inputs, 100u);
    EXPECT_LT(glm::distance(run.states.back().position_ned_m, home.position_ned_m), 0.01);
    EXPECT_LT(glm::length(run.states.back().velocity.linear()), 0.01);
  }
}

TEST(RovExtremes, TeleportsToRestAndRefusesNowhere) {
  const Vehicle vehicle = heavy_vehicle();
  Inputs inputs;
  inputs.thruster_n.fill(30.0);
  State state;
  for (int i = 0; i < 240; ++i) state = step(vehicle, state, inputs, 1.0 / 240.0);
  const State before = state;
  EXPECT_FALSE(teleport(state, {kNan, 0, 0}, {1, 0, 0, 0}));
  EXPECT_FALSE(teleport(state, {0, 0, 0}, {0, 0, 0, 0}));
  EXPECT_FALSE(teleport(state, {0, 0, 0}, {kNan, 0, 0, 0}));
  EXPECT_EQ(state.position_ned_m, before.position_ned_m);
  EXPECT_TRUE(teleport(state, {1e5, 2, 3}, {2, 0, 0, 0}));
  EXPECT_EQ(state.velocity, Vec6{});
  EXPECT_EQ(state.attitude.w, 1.0);
  EXPECT_TRUE(all_finite(step(vehicle, state, inputs, 1.0 / 240.0)));
}

TEST(RovExtremes, FliesToItsSetpointAfterAllThat) {
  const Vehicle vehicle = heavy_vehicle();
  Draws draws(3);
  State state = random_state(draws, 3.0);
  Inputs inputs;
  inputs.wrench = {{1e4, -1e4, 1e4, 2e3, 2e3, -2e3}};
  inputs.current_ned_m_s = {5, 0, 0};
  for (int i = 0; i < 5; ++i) state = step(vehicle, state, inputs, 1.0);
  inputs.wrench[0] = kNan;
  inputs.current_ned_m_s.x = kNan;
  state = step(vehicle, state, inputs, 1.0);
  Setpoint home;
  home.position_ned_m = state.position_ned_m + Vec3(1.0, 1.0, 1.0);
  state.held = {};
  const LoopRun run = fly(
      vehicle, default_gains(), state, [&](const State&, double) { return home; }, 60.0);
  EXPECT_LT(glm::distance(run.states.back().position_ned_m, home.position_ned_m), 0.02);
}

TEST(RovExtremes, ParametersThatAreNoVehicleAreErrors) {
  const auto said = [](const auto& change) {
    VehicleParameters p = bluerov2_heavy();
    change(p);
    const auto vehicle = make_vehicle(p);
    return vehicle.ok() ? "" : vehicle.error().message;
  };
  using ::testing::HasSubstr;
  EXPECT_EQ(said([](auto&) {}), "");
  EXPECT_THAT(said([](auto& p) { p.mass_kg = -1; }),
              HasSubstr("mass_kg: found -1; accepted: a number in"));
  EXPECT_THAT(said([](auto& p) { p.mass_kg = kNan; }), HasSubstr("mass_kg: found nan"));
  EXPECT_THAT(said([](auto& p) { p.weight_n = -5; }), HasSubstr("weight_n: found -5"));
  EXPECT_THAT(said([](auto& p) { p.inertia_kg_m2 = Mat3(0.0); }),
              HasSubstr("inertia_kg_m2: found a mass"));
  EXPECT_THAT(said([](auto& p) {
                p.gravity_centre_m = {0, 0, 1};
              }),
              HasSubstr("with mass 13.5 and centre of gravity (0, 0, 1)"));
  EXPECT_THAT(
      said([](auto& p) { p.added_mass(0, 1) = p.added_mass(1, 0) = 30; }),
      HasSubstr("added_mass: found a sum with the rigid body's mass matrix that is not positive"));
  EXPECT_THAT(said([](auto& p) { p.added_mass(2, 2) = -3; }), HasSubstr("added_mass: found -3"));
  EXPECT_THAT(said([](auto& p) { p.quadratic_damping[4] = -3; }),
              HasSubstr("quadratic_damping: found -3"));
  EXPECT_THAT(said([](auto& p) { p.thrusters.resize(17); }),
              HasSubstr("found 17; accepted: up to 16"));
  EXPECT_THAT(said([](auto& p) { p.lag.a1 = 1.0; }), HasSubstr("stable poles"));
  EXPECT_THAT(said([](auto& p) { p.tether = Tether{.length_m = -1.0}; }),
              HasSubstr("tether.length_m: found -1; accepted: [0.1, 100000]"));
}

}  // namespace
}  // namespace neritic::rov
