// The tether against its closed forms, and a vehicle that pulls on it.
#include "rov/tether.hpp"

#include <gtest/gtest.h>

#include "rov/step.hpp"
#include "tests/rov/random_vehicle.hpp"

namespace neritic::rov {
namespace {

constexpr Vec3 kAnchor(0.0, 0.0, 0.0);

TEST(RovTether, SlackInStillWaterItOnlyWeighs) {
  Tether t;
  EXPECT_EQ(tether_force_n(t, kAnchor, {20, 0, 10}, Vec3(0.0), Vec3(0.0)), Vec3(0.0));
  t.net_weight_n_m = 0.1;
  EXPECT_EQ(tether_force_n(t, kAnchor, {20, 0, 10}, Vec3(0.0), Vec3(0.0)), Vec3(0, 0, 2.5));
}

TEST(RovTether, TautItPullsAsASpring) {
  Tether t;
  t.length_m = 20.0;
  const Vec3 force = tether_force_n(t, kAnchor, {20.1, 0, 0}, Vec3(0.0), Vec3(0.0));
  EXPECT_NEAR(force.x, -2e4 * 0.1 / 20.0, 1e-9);
  // Damping slows what stretches it, but never pushes.
  EXPECT_LT(tether_force_n(t, kAnchor, {20.1, 0, 0}, {1, 0, 0}, Vec3(0.0)).x, force.x);
  t.tangential_drag = 0.0;
  EXPECT_EQ(tether_force_n(t, kAnchor, {20.1, 0, 0}, {-50, 0, 0}, Vec3(0.0)).x, 0.0);
}

TEST(RovTether, DragIsTheIntegralOverTheCable) {
  // Across: a length element at share s moves at s v and hangs on the vehicle by the share s, so
  // the integral of s (s v)^2 is v^2 / 4. In a current alone it is u^2 / 2.
  const Tether t;
  const double q = 0.5 * t.water_kg_m3 * t.diameter_m * t.length_m * t.normal_drag;
  const Vec3 across = tether_force_n(t, kAnchor, {40, 0, 0}, {0, 0.5, 0}, Vec3(0.0));
  EXPECT_NEAR(across.y, -q * 0.25 / 4.0, 1e-9);
  const Vec3 current = tether_force_n(t, kAnchor, {40, 0, 0}, Vec3(0.0), {0, 0.5, 0});
  EXPECT_NEAR(current.y, q * 0.25 / 2.0, 1e-9);
  const Vec3 along = tether_force_n(t, kAnchor, {40, 0, 0}, Vec3(0.0), {0.5, 0, 0});
  EXPECT_NEAR(along.x, q / t.normal_drag * kPi * t.tangential_drag * 0.25 / 2.0, 1e-9);
}

TEST(RovTether, AVehicleAtFullThrustIsHeldAtItsEnd) {
  VehicleParameters p = bluerov2_heavy();
  p.buoyancy_n = p.weight_n;
  p.lag.kind = ThrusterLag::Kind::kNone;
  Tether tether;
  tether.length_m = 10.0;
  p.tether = tether;
  const Vehicle vehicle = make_vehicle(p).value();
  Inputs inputs;
  inputs.wrench = {{100, 0, 0, 0, 0, 0}};
  for (const double dt : {1.0 / 240.0, 0.02, 0.5}) {
    State state;
    double farthest = 0.0;
    for (double t = 0.0; t < 60.0; t += dt) {
      state = step(vehicle, state, inputs, dt);
      farthest = std::max(farthest, state.position_ned_m.x);
    }
    EXPECT_NEAR(state.position_ned_m.x, 10.0 * (1.0 + 100.0 / 2e4), 1e-3) << dt;
    EXPECT_LT(farthest, 10.5) << dt;
    EXPECT_LT(glm::length(state.velocity.linear()), 1e-3) << dt;
  }
}

TEST(RovTether, EnergyNeverGrowsOnASlackTether) {
  VehicleParameters p = bluerov2_heavy();
  p.buoyancy_n = p.weight_n;
  p.tether = Tether{};
  const Vehicle vehicle = make_vehicle(p).value();
  for (std::uint64_t index = 0; index < 20; ++index) {
    Draws draws(index);
    State state = random_state(draws, 1.0);
    state.position_ned_m = 0.3 * state.position_ned_m;
    double before = 1e300;
    for (int i = 0; i < 500; ++i) {
      const double now =
          kinetic_energy(vehicle, state, Vec3(0.0)) + potential_energy(vehicle, state);
      ASSERT_LE(now, before + 1e-9);
      before = now;
      state = step(vehicle, state, {}, 0.01);
    }
  }
}

}  // namespace
}  // namespace neritic::rov
