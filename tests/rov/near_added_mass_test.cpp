// Added mass near a wall and under the surface: the image's numbers, Lagrange's motion with its
// energy and its momentum along the wall, and extremes.
#include "rov/near_added_mass.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rov/step.hpp"

namespace neritic::rov {
namespace {

constexpr double kSphere_m = 0.2, kDense_kg_m3 = 1000.0;

// A neutral sphere without drag, or a body whose added mass differs by axis.
Vehicle free_body(const Vec3& added_share = Vec3(0.5)) {
  VehicleParameters p;
  p.name = "body";
  p.mass_kg = kDense_kg_m3 * 4.0 / 3.0 * kPi * std::pow(kSphere_m, 3.0);
  p.inertia_kg_m2 = Mat3(0.4 * p.mass_kg * kSphere_m * kSphere_m);
  p.weight_n = p.buoyancy_n = 9.81 * p.mass_kg;
  for (std::size_t i = 0; i < 3; ++i)
    p.added_mass(i, i) = added_share[static_cast<int>(i)] * p.mass_kg;
  return make_vehicle(p).value();
}

// Over a bottom at the depth 0; north, east, down.
struct Flight {
  Vehicle open = free_body();
  Vec3 normal_ned{0.0, 0.0, -1.0};
  bool free_surface = false;
  State state;
  double away_m() const { return glm::dot(state.position_ned_m, normal_ned); }
  WaterBound bound() const { return {away_m(), normal_ned, free_surface}; }
  // J, of the motion with the mass that the body has there.
  double energy_j() const {
    Vehicle near = open;
    const WaterBound here = bound();
    near_added_mass(open, kSphere_m, {&here, 1}, state.attitude, state.velocity, near);
    return 0.5 * dot(state.velocity, near.mass * state.velocity);
  }
  Vec3 momentum_ned() const {
    Vehicle near = open;
    const WaterBound here = bound();
    near_added_mass(open, kSphere_m, {&here, 1}, state.attitude, state.velocity, near);
    return state.attitude * (near.mass * state.velocity).linear();
  }
  void run(double seconds, double dt_s) {
    Vehicle near = open;
    for (double t = 0.0; t < seconds - 0.5 * dt_s; t += dt_s) {
      Inputs inputs;
      const WaterBound here = bound();
      inputs.wrench =
          near_added_mass(open, kSphere_m, {&here, 1}, state.attitude, state.velocity, near);
      state = step(near, state, inputs, dt_s, Integrator::kRk4);
    }
  }
};

TEST(NearAddedMass, IsTheFirstImages) {
  EXPECT_NEAR(displaced_radius_m(free_body(), kDense_kg_m3), kSphere_m, 1e-12);
  const AddedShare share = added_share(kSphere_m, {0.4});
  EXPECT_NEAR(share.along, 3.0 / 16.0 / 8.0, 1e-15);
  EXPECT_NEAR(share.across, 3.0 / 8.0 / 8.0, 1e-15);
  const double h = 1e-6;
  EXPECT_NEAR(
      share.across_1_m,
      (added_share(kSphere_m, {0.4 + h}).across - added_share(kSphere_m, {0.4 - h}).across) /
          (2.0 * h),
      1e-8);
  const AddedShare under = added_share(kSphere_m, {0.4, Vec3(0, 0, 1), true});
  EXPECT_EQ(under.along, -share.along);
  EXPECT_EQ(under.across, -share.across);
  // The wall's: 0.6875 of the displaced mass across while it touches, and no more within it.
  EXPECT_NEAR(0.5 * (1.0 + added_share(kSphere_m, {kSphere_m}).across), 0.6875, 1e-12);
  EXPECT_EQ(added_share(kSphere_m, {-1.0}).across, 0.375);
  EXPECT_EQ(added_share(kSphere_m, {-1.0}).across_1_m, 0.0);
  EXPECT_EQ(added_share(kSphere_m, {10.1 * kSphere_m}).across, 0.0);
}

TEST(NearAddedMass, AMotionKeepsItsEnergyAndWhatItHasAlongTheWall) {
  for (const double dt_s : {2e-3, 5e-4}) {
    Flight flight;
    flight.state.position_ned_m = {0.0, 0.0, -0.6};
    flight.state.velocity = vec6(Vec3(0.4, 0.1, 0.2), Vec3(0.0));  // slanting down to it
    const double energy_j = flight.energy_j();
    const Vec3 momentum = flight.momentum_ned();
    flight.run(1.8, dt_s);
    EXPECT_LT(flight.away_m(), 0.3);
    EXPECT_GT(flight.away_m(), kSphere_m);
    EXPECT_NEAR(flight.energy_j() / energy_j, 1.0, 0.5 * dt_s);
    EXPECT_NEAR(flight.momentum_ned().x / momentum.x, 1.0, 0.5 * dt_s);
    EXPECT_NEAR(flight.momentum_ned().y / momentum.y, 1.0, 0.5 * dt_s);
    // A sphere is not turned.
    EXPECT_LT(glm::length(flight.state.velocity.angular()), 1e-3 * dt_s);
  }
}

// With added mass that differs by axis, turning: the moments belong to it.
TEST(NearAddedMass, ABodyThatTurnsKeepsItsEnergyToo) {
  double before = 0.0;
  for (const double dt_s : {1e-3, 2.5e-4}) {
    Flight flight;
    flight.open = free_body({0.3, 0.6, 1.0});
    flight.normal_ned = glm::normalize(Vec3(0.3, -0.2, -1.0));
    flight.state.position_ned_m = 0.45 * flight.normal_ned;
    flight.state.attitude = glm::normalize(Quat(0.8, 0.3, -0.4, 0.2));
    flight.state.velocity = vec6(Vec3(0.2, -0.1, 0.15), Vec3(0.7, -0.5, 0.9));
    const double energy_j = flight.energy_j();
    flight.run(1.0, dt_s);
    const double off = std::abs(flight.energy_j() / energy_j - 1.0);
    EXPECT_LT(off, dt_s);
    if (before > 0.0) {
      EXPECT_LT(off, 0.4 * before);  // of first order
    }
    before = off;
  }
}

// Milne-Thomson 1968: drawn to a wall along which it moves by 9/32 of the added mass, a^3 / h^4,
// and pushed off a free surface as much.
TEST(NearAddedMass, AlongAWallItIsDrawnToIt) {
  Flight flight;
  flight.state.position_ned_m = {0.0, 0.0, -0.5};
  flight.state.velocity = vec6(Vec3(1.0, 0.0, 0.0), Vec3(0.0));
  Vehicle near = flight.open;
  const double added_kg = 0.5 * flight.open.mass_kg;
  const double drawn_n = 9.0 / 32.0 * added_kg * std::pow(kSphere_m, 3.0) / std::pow(0.5, 4.0);
  const WaterBound wall = flight.bound();
  EXPECT_NEAR(near_added_mass(flight.open, kSphere_m, {&wall, 1}, flight.state.attitude,
                              flight.state.velocity, near)
                  .linear()
                  .z,
              drawn_n, 1e-12);
  WaterBound surface = wall;
  surface.free_surface = true;
  EXPECT_NEAR(near_added_mass(flight.open, kSphere_m, {&surface, 1}, flight.state.attitude,
                              flight.state.velocity, near)
                  .linear()
                  .z,
              -drawn_n, 1e-12);
}

TEST(NearAddedMass, FarOffNothingChangesAndExtremesAreFinite) {
  const Vehicle open = free_body();
  Vehicle near = open;
  const Vec6 fast = vec6(Vec3(50.0, -50.0, 50.0), Vec3(20.0));
  const WaterBound far{1e7};
  const Vec6 none = near_added_mass(open, kSphere_m, {&far, 1}, Quat(1, 0, 0, 0), fast, near);
  EXPECT_EQ(dot(none, none), 0.0);
  EXPECT_EQ(near.mass, open.mass);
  EXPECT_EQ(near.inverse_mass, open.inverse_mass);
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double away_m : {-1e9, -0.0, 1e-300, kSphere_m, 1.999, kInf, -kInf, std::nan("")})
    for (const bool surface : {false, true}) {
      const WaterBound both[] = {{away_m, Vec3(0, 0, -1), surface}, {away_m, Vec3(0, 0, 1), true}};
      const Vec6 wrench = near_added_mass(open, kSphere_m, both, Quat(0.6, 0.8, 0, 0), fast, near);
      EXPECT_TRUE(is_finite(wrench)) << away_m;
      EXPECT_TRUE(is_finite(near.inverse_mass)) << away_m;
      EXPECT_GT(smallest_pivot(near.mass), 0.0) << away_m;
    }
}

}  // namespace
}  // namespace neritic::rov
