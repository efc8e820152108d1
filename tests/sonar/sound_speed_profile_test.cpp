// Rays through sound speed profiles against closed forms (uniform water, a single gradient's
// circle), an independent numerical integration, and their own invariants.
#include "sonar/sound_speed_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/math.hpp"
#include "sonar/range_correction.hpp"

namespace neritic {
namespace {

using sonar::RayPoint;
using sonar::SoundSpeedProfile;

SoundSpeedProfile profile(scene::SonarTable rows) {
  auto made = SoundSpeedProfile::of_table(std::move(rows));
  EXPECT_TRUE(made.ok());
  return std::move(made).value();
}
// Thermocline over a deep minimum, as in summer at middle latitudes.
SoundSpeedProfile ocean() {
  return profile({{0, 1520}, {20, 1519}, {60, 1495}, {200, 1490}, {1000, 1482}, {5000, 1550}});
}
// Three thousand metres of one gradient.
SoundSpeedProfile one_gradient(double gradient_s) {
  return profile({{0, 1500}, {3000, 1500 + 3000 * gradient_s}});
}

TEST(SonarProfile, IsInterpolatedAndHeldBeyondItsEnds) {
  const auto read = profile({{0, 1500}, {100, 1520}});
  EXPECT_EQ(read.speed_m_s(25), 1505.0);
  EXPECT_EQ(read.speed_m_s(-5), 1500.0);
  EXPECT_EQ(read.speed_m_s(11000), 1520.0);
  EXPECT_FALSE(SoundSpeedProfile::of_table({{0, 1500}, {0, 1510}}).ok());
  EXPECT_FALSE(SoundSpeedProfile::of_table({{0, 1.5}}).ok());
  EXPECT_FALSE(SoundSpeedProfile::of_table({}).ok());
}

TEST(SonarStraightRays, TakeRangeOverSpeedInUniformWater) {
  const auto uniform = profile({{0, 1480}});
  for (const double elevation : {-90.0, -30.0, 0.0, 89.99})
    for (const double range : {0.05, 10.0, 1e4, 1e6}) {
      const double time = uniform.straight_time_s(50, radians(elevation), range);
      EXPECT_NEAR(time, range / 1480, 1e-15 * range);
    }
  EXPECT_EQ(uniform.straight_time_s(50, 0.1, 0.0), 0.0);
}

TEST(SonarStraightRays, TakeALogarithmOfTimeInOneGradient) {
  const auto water = one_gradient(0.017);
  // Straight down 1000 m: ln(c2 / c1) / g.
  EXPECT_NEAR(water.straight_time_s(0, -kPi / 2, 1000), std::log(1517.0 / 1500.0) / 0.017, 1e-14);
  // Up at 30 degrees from 900 m to 400 m.
  EXPECT_NEAR(water.straight_time_s(900, radians(30), 1000),
              2.0 * std::log((1500 + 15.3) / (1500 + 6.8)) / 0.017, 1e-14);
}

TEST(SonarStraightRays, AreTheIntegralOfSlownessThroughLayers) {
  const auto water = ocean();
  for (const double launch : {0.0, 20.0, 59.0, 3000.0})
    for (const double elevation_deg : {-90.0, -40.0, -1.0, -1e-6, 0.0, 1e-6, 1.0, 60.0}) {
      const double elevation = radians(elevation_deg), range = 2500.0;
      const int n = 200000;
      double sum = 0.0;
      for (int i = 0; i < n; ++i) {
        const double s = (i + 0.5) * range / n;
        sum += range / n / water.speed_m_s(launch - s * std::sin(elevation));
      }
      const double time = water.straight_time_s(launch, elevation, range);
      EXPECT_NEAR(time, sum, 2e-10) << launch << ' ' << elevation_deg;
    }
}

TEST(SonarStraightRays, GiveNaNForNaN) {
  EXPECT_TRUE(std::isnan(ocean().straight_time_s(std::nan(""), 0, 1)));
  EXPECT_TRUE(std::isnan(ocean().bent(0, 0, std::nan("")).depth_m));
}

TEST(SonarBentRays, AreStraightInUniformWater) {
  const auto uniform = profile({{0, 1480}});
  // Split by rows of equal speed, too.
  const auto split = profile({{0, 1480}, {10, 1480}, {200, 1480}});
  for (const auto* water : {&uniform, &split})
    for (const double elevation : {-kPi / 2, -0.3, -1e-9, 0.0, 0.7, kPi / 2}) {
      const RayPoint end = water->bent(100, elevation, 2.0);
      EXPECT_NEAR(end.arc_m, 2960, 1e-9);
      EXPECT_NEAR(end.horizontal_m, 2960 * std::cos(elevation), 1e-9);
      EXPECT_NEAR(end.depth_m, 100 - 2960 * std::sin(elevation), 1e-9);
      EXPECT_EQ(end.elevation_rad, elevation);
    }
}

TEST(SonarBentRays, FollowACircleInOneGradient) {
  for (const double gradient : {0.05, -0.05, 0.017, 1e-9})
    for (const double elevation : {-0.4, -0.01, 0.0, 0.02, 0.3}) {
      const auto water = one_gradient(gradient);
      const double launch = 1500, speed = water.speed_m_s(launch);
      const double radius = speed / (gradient * std::cos(elevation));
      const RayPoint end = water.bent(launch, elevation, 0.8);
      // Angles are told apart to some 1e-16, which is what the radius makes of it.
      const double turn = end.elevation_rad - elevation;
      const double exact_m = 1e-9 + 1e-15 * std::abs(radius);
      EXPECT_NEAR(end.arc_m, radius * turn, exact_m);
      EXPECT_NEAR(end.horizontal_m,
                  2 * radius * std::sin(turn / 2) * std::cos(elevation + turn / 2), exact_m);
      // Snell, and travel time by the Gudermannian.
      EXPECT_NEAR(std::cos(end.elevation_rad) / water.speed_m_s(end.depth_m),
                  std::cos(elevation) / speed, 1e-15);
      EXPECT_NEAR(
          (std::atanh(std::sin(end.elevation_rad)) - std::atanh(std::sin(elevation))) / gradient,
          0.8, 1e-12 + 1e-15 / std::abs(gradient));
    }
}

TEST(SonarBentRays, TurnAtTheDepthThatSnellNames) {
  const auto water = one_gradient(0.1);
  const double elevation = radians(-10.0);  // downwards into faster water
  const double vertex = (1500 / std::cos(elevation) - 1500) / 0.1;
  double deepest = 0.0;
  for (double t = 0.0; t < 3.0; t += 1e-3)
    deepest = std::max(deepest, water.bent(0, elevation, t).depth_m);
  EXPECT_NEAR(deepest, vertex, 1e-3);
  // Back at the launch depth after 2 R sin(angle), as steep upwards as it went down.
  const double time = 2.0 * std::atanh(std::sin(-elevation)) / 0.1;
  const RayPoint back = water.bent(0, elevation, time);
  EXPECT_NEAR(back.depth_m, 0.0, 1e-8);
  EXPECT_NEAR(back.horizontal_m, 2 * 1500 / 0.1 * std::tan(-elevation), 1e-8);
  EXPECT_NEAR(back.elevation_rad, -elevation, 1e-12);
}

// Fourth-order Runge-Kutta over small steps of time: x, z, angle.
RayPoint integrated(const SoundSpeedProfile& water, double depth, double elevation, double time) {
  const int n = 400000;
  const double h = time / n;
  double x = 0.0, z = depth, a = -elevation, arc = 0.0;
  const auto gradient = [&](double at) {
    return (water.speed_m_s(at + 1e-4) - water.speed_m_s(at - 1e-4)) / 2e-4;
  };
  for (int i = 0; i < n; ++i) {
    double sx = 0, sz = 0, sa = 0, ss = 0, kz = 0, ka = 0;
    for (const auto& [step, weight] : {std::pair{0.0, 1.0}, {0.5, 2.0}, {0.5, 2.0}, {1.0, 1.0}}) {
      const double zi = z + step * h * kz, ai = a + step * h * ka, c = water.speed_m_s(zi);
      kz = c * std::sin(ai), ka = -gradient(zi) * std::cos(ai);
      sx += weight * c * std::cos(ai), sz += weight * kz, sa += weight * ka, ss += weight * c;
    }
    x += h / 6 * sx, z += h / 6 * sz, a += h / 6 * sa, arc += h / 6 * ss;
  }
  return {x, z, arc, -a};
}

TEST(SonarBentRays, AgreeWithNumericalIntegrationThroughManyLayers) {
  const auto water = ocean();
  for (const double elevation_deg : {-85.0, -20.0, -3.0, 0.0, 2.0, 12.0}) {
    const double elevation = radians(elevation_deg);
    const RayPoint exact = water.bent(150, elevation, 4.0);
    const RayPoint stepped = integrated(water, 150, elevation, 4.0);
    EXPECT_NEAR(exact.horizontal_m, stepped.horizontal_m, 0.05) << elevation_deg;
    EXPECT_NEAR(exact.depth_m, stepped.depth_m, 0.05) << elevation_deg;
    EXPECT_NEAR(exact.arc_m, stepped.arc_m, 0.05) << elevation_deg;
    EXPECT_NEAR(exact.elevation_rad, stepped.elevation_rad, 1e-4) << elevation_deg;
  }
}

TEST(SonarBentRays, VerticalRaysAreStraightAndTakeTheStraightTime) {
  const auto water = ocean();
  for (const double elevation : {-kPi / 2, kPi / 2}) {
    const double time = water.straight_time_s(700, elevation, 650);
    const RayPoint end = water.bent(700, elevation, time);
    EXPECT_NEAR(end.arc_m, 650, 1e-9);
    EXPECT_NEAR(end.depth_m, 700 - 650 * std::sin(elevation), 1e-9);
    EXPECT_NEAR(end.horizontal_m, 0.0, 1e-9);
  }
}

TEST(SonarBentRays, KeepSnellsInvariantOverHugeRangesAndGrazingAngles) {
  const auto water = ocean();
  for (const double launch : {1000.0, 999.999, 20.0, 300.0})
    for (const double elevation : {0.0, 1e-12, -1e-9, 1e-6, -1e-3, 0.1}) {
      const RayPoint end = water.bent(launch, elevation, 700.0);  // a thousand kilometres
      ASSERT_TRUE(std::isfinite(end.horizontal_m) && std::isfinite(end.depth_m));
      EXPECT_NEAR(std::cos(end.elevation_rad) / water.speed_m_s(end.depth_m) /
                      (std::cos(elevation) / water.speed_m_s(launch)),
                  1.0, 1e-10)
          << launch << ' ' << elevation;
      EXPECT_LE(end.horizontal_m, end.arc_m * (1 + 1e-12));
      EXPECT_GE(end.arc_m, 700.0 * 1482 * (1 - 1e-12));
      EXPECT_LE(end.arc_m, 700.0 * 1550);
    }
  // Level at the minimum of the speed it stays there.
  const RayPoint channel = water.bent(1000.0, 0.0, 700.0);
  EXPECT_EQ(channel.depth_m, 1000.0);
  EXPECT_NEAR(channel.horizontal_m, 700.0 * 1482, 1e-6);
}

TEST(SonarBentRays, AreTheSameInOneStepOrInTwo) {
  const auto water = ocean();
  for (const double elevation : {-0.2, -0.004, 0.03}) {
    const RayPoint half = water.bent(80, elevation, 3.0), whole = water.bent(80, elevation, 6.0);
    const RayPoint rest = water.bent(half.depth_m, half.elevation_rad, 3.0);
    EXPECT_NEAR(half.horizontal_m + rest.horizontal_m, whole.horizontal_m, 1e-7);
    EXPECT_NEAR(rest.depth_m, whole.depth_m, 1e-7);
    EXPECT_NEAR(half.arc_m + rest.arc_m, whole.arc_m, 1e-7);
  }
}

TEST(SonarBentRays, LeaveACrestOfSpeedDownwards) {
  // Level on a maximum of speed, either way is right; below is chosen, and it does not stay.
  const auto crest = profile({{0, 1490}, {50, 1500}, {100, 1490}});
  const RayPoint end = crest.bent(50, 0.0, 0.5);
  EXPECT_GT(end.depth_m, 60.0);
  // Only the water above bends: upwards.
  const auto above = profile({{0, 1490}, {50, 1500}, {100, 1500}});
  EXPECT_LT(above.bent(50, 0.0, 0.5).depth_m, 40.0);
}

// A thermocline in 2000 rows, as instruments give it.
scene::SonarTable many_rows() {
  scene::SonarTable rows;
  for (int i = 0; i < 2000; ++i) {
    const double depth = 0.1 * i;
    rows.push_back({depth, 1500.0 + 12.0 / (1.0 + std::exp((depth - 40.0) / 6.0)) + 0.016 * depth});
  }
  return rows;
}

// In a constant gradient a ray is an arc of a circle about a point at the depth where the speed
// would be 0: that circle through both ends says how it leaves.
TEST(SonarRangeCorrection, BentRaysLeaveAlongTheirCircle) {
  const double launch_m = 1000.0, reach_m = 400.0;
  for (const double gradient_s : {-2.0, -0.05, 0.017, 0.5, 2.0}) {
    const double c0 = 3000.0, centre_m = launch_m - c0 / gradient_s;
    const scene::SonarProfile profile{
        {{0.0, c0 - gradient_s * launch_m}, {2.0 * launch_m, c0 + gradient_s * launch_m}}, true};
    const auto table = sonar::range_correction(profile, launch_m, reach_m, c0);
    ASSERT_EQ(table.bends.size(), table.factors.size());
    double most_rad = 0.0;
    for (std::uint32_t j = 1; j + 1 < table.height; ++j)
      for (std::uint32_t i = 1; i < table.width; ++i) {
        const double sine = -1.0 + 2.0 * j / (table.height - 1);
        const double r = reach_m * i / (table.width - 1);
        const double x = r * std::sqrt(1.0 - sine * sine), z = launch_m - r * sine;
        const double centre_x = (x * x + (z - centre_m) * (z - centre_m) -
                                 (launch_m - centre_m) * (launch_m - centre_m)) /
                                (2.0 * x);
        const double leaves_rad = -std::atan(centre_x * gradient_s / c0);
        const double bend_rad = table.bends[std::size_t{j} * table.width + i];
        EXPECT_NEAR(std::asin(sine) + bend_rad, leaves_rad, 2e-6) << gradient_s << ' ' << r;
        most_rad = std::max(most_rad, std::abs(bend_rad));
      }
    const double bound_rad = sonar::most_bend_rad(profile, reach_m);
    EXPECT_GE(bound_rad, most_rad);
    EXPECT_LT(bound_rad, 3.5 * most_rad);
  }
  EXPECT_TRUE(sonar::range_correction({{{0, 1500}, {9, 1600}}, false}, 1, 9, 1500).bends.empty());
}

TEST(SonarRangeCorrection, ManyRowsAreThinnedWithinTheirTolerance) {
  const scene::SonarTable rows = many_rows(), few = sonar::simplified(rows);
  EXPECT_LT(few.size(), 120u);
  for (double depth = 0.0; depth < 200.0; depth += 0.013)
    EXPECT_NEAR(sonar::interpolate(few, depth), sonar::interpolate(rows, depth), 0.0101);
  // Rows without any order keep to the limit.
  scene::SonarTable noisy;
  for (int i = 0; i < 100000; ++i) noisy.push_back({0.05 * i, 1500.0 + (i * 7919 % 101) * 0.1});
  EXPECT_LE(sonar::simplified(noisy).size(), sonar::kMostRows);
  EXPECT_EQ(sonar::simplified({{0, 1500}, {9, 1490}}).size(), 2u);
  const auto exact = sonar::range_correction({rows, true}, 20.0, 100.0, 1500.0);
  const auto thinned = sonar::range_correction({few, true}, 20.0, 100.0, 1500.0);
  for (std::size_t i = 0; i < exact.factors.size(); ++i)
    EXPECT_NEAR(thinned.factors[i], exact.factors[i], 1e-5) << i;
}

TEST(SonarRangeCorrection, ATableIsMadeOncePerDepth) {
  sonar::RangeCorrections corrections;
  const scene::SonarProfile profile{many_rows(), true};
  const float there = corrections.at(profile, 20.0, 100.0).factors[70];
  for (const double depth : {20.0, 20.01, 19.99}) corrections.at(profile, depth, 100.0);
  EXPECT_EQ(corrections.made(), 1u);
  corrections.at(profile, 24.0, 100.0);
  EXPECT_EQ(corrections.made(), 2u);
  EXPECT_EQ(corrections.at(profile, 20.02, 100.0).factors[70], there);
  corrections.at({{{0, 1500}}, false}, 20.0, 100.0);
  EXPECT_EQ(corrections.made(), 4u);
}

}  // namespace
}  // namespace neritic
