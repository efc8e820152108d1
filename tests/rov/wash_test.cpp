// The wash of a thruster against the laws of round jets.
#include "rov/wash.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace neritic::rov {
namespace {

constexpr double kWater = 1025.0;
const WashJet kJet{Vec3(0.0), Vec3(1.0, 0.0, 0.0), 40.0, 0.076};

TEST(Wash, LeavesWithTheThrustsMomentumAndDecaysAsMeasured) {
  // T = rho u0^2 pi D^2 / 4.
  const double u0 = jet_exit_m_s(kJet, kWater);
  EXPECT_NEAR(kWater * u0 * u0 * std::numbers::pi / 4.0 * 0.076 * 0.076, 40.0, 1e-9);
  EXPECT_NEAR(u0, 2.933, 1e-3);
  EXPECT_EQ(jet_axis_m_s(kJet, 0.3, kWater), u0);  // in the core
  for (const double x : {1.0, 3.0, 10.0})
    EXPECT_NEAR(jet_axis_m_s(kJet, x, kWater) / u0, 6.2 * 0.076 / x, 1e-12);
  EXPECT_EQ(jet_axis_m_s(kJet, -0.1, kWater), 0.0);
  EXPECT_EQ(glm::length(jet_velocity_m_s(kJet, Vec3(-0.5, 0.0, 0.0), kWater)), 0.0);
}

TEST(Wash, SpreadsAsPeopleMeasuredBecauseItKeepsItsMomentum) {
  for (const double x : {1.0, 5.0}) {
    EXPECT_NEAR(jet_half_width_m(kJet, x, kWater) / x, 0.095, 0.001);
    // The flux of momentum by the profile: integral of rho u^2 2 pi r dr.
    double flux = 0.0;
    constexpr double kStep = 1e-3;
    for (double r = 0.5 * kStep; r < 5.0; r += kStep) {
      const double u = jet_velocity_m_s(kJet, Vec3(x, r, 0.0), kWater).x;
      flux += kWater * u * u * 2.0 * std::numbers::pi * r * kStep;
    }
    EXPECT_NEAR(flux, 40.0, 0.01);
    const double b = jet_half_width_m(kJet, x, kWater);
    EXPECT_NEAR(jet_velocity_m_s(kJet, Vec3(x, 0.0, b), kWater).x,
                0.5 * jet_axis_m_s(kJet, x, kWater), 1e-12);
  }
}

TEST(Wash, ExtremesAreFinite) {
  for (const double thrust : {0.0, 1e-300, 1e9})
    for (const double diameter : {0.005, 10.0})
      for (const Vec3& at : {Vec3(0.0), Vec3(1e7, 1e-9, 0.0), Vec3(1e-300, 1e6, -1e6)}) {
        const WashJet jet{Vec3(0.0), Vec3(1.0, 0.0, 0.0), thrust, diameter};
        const Vec3 u = jet_velocity_m_s(jet, at, kWater);
        EXPECT_TRUE(std::isfinite(u.x) && u.x >= 0.0) << thrust << " " << diameter;
      }
}

TEST(Wash, ThrustGrowsNearAWallAsAboveGround) {
  // 1 / (1 - (R / 4 z)^2).
  EXPECT_NEAR(ground_effect(0.076, 0.038), 1.0 / (1.0 - 1.0 / 16.0), 1e-12);
  EXPECT_NEAR(ground_effect(0.076, 0.076), 1.0 / (1.0 - 1.0 / 64.0), 1e-12);
  EXPECT_EQ(ground_effect(0.076, 0.0), ground_effect(0.076, 0.038));
  EXPECT_NEAR(ground_effect(0.076, 1.0), 1.0, 1e-4);
}

}  // namespace
}  // namespace neritic::rov
