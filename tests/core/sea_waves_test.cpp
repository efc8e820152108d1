// The waves have the spectrum that they are made of, move as deep water's do, and are the same
// everywhere.
#include "engine/core/sea_waves.hpp"

#include <gtest/gtest.h>

namespace neritic {
namespace {

constexpr SeaState kSea{
    .wind_m_s = 7.0, .fetch_m = 20000.0, .direction_rad = 0.7, .components = 32, .seed = 3};

TEST(SeaWaves, SignificantHeightIsHasselmannsOfTheFetch) {
  // Hasselmann et al. 1973: energy 1.6e-7 of the dimensionless fetch, Hs = 4 sqrt(energy). Their
  // fits of alpha, peak and gamma, which the spectrum uses, give a height 15 to 20 % above it.
  for (const double wind : {4.0, 7.0, 12.0})
    for (const double fetch : {2e3, 20e3, 60e3}) {
      SeaState sea = kSea;
      sea.wind_m_s = wind;
      sea.fetch_m = fetch;
      const double hasselmann =
          4.0 * std::sqrt(1.6e-7 * 9.81 * fetch / (wind * wind)) * wind * wind / 9.81;
      if (9.81 * fetch / (wind * wind) > 1e4) continue;  // fully grown
      EXPECT_NEAR(4.0 * SeaWaves(sea).height_rms_m(), hasselmann, 0.22 * hasselmann)
          << wind << " " << fetch;
    }
}

TEST(SeaWaves, VarianceOverPlaceAndTimeIsTheSpectrums) {
  const SeaWaves waves(kSea);
  double sum = 0.0, sum2 = 0.0, slope2 = 0.0;
  constexpr int kN = 20000;
  for (int i = 0; i < kN; ++i) {
    const double x = 137.31 * i, z = -71.77 * i, t = 0.37 * i;
    const double h = waves.height_m(x, z, t);
    sum += h;
    sum2 += h * h;
    const Vec2 s = waves.slope(x, z, t);
    slope2 += glm::dot(s, s);
  }
  EXPECT_NEAR(sum / kN, 0.0, 0.02 * waves.height_rms_m());
  EXPECT_NEAR(std::sqrt(sum2 / kN), waves.height_rms_m(), 0.03 * waves.height_rms_m());
  EXPECT_NEAR(slope2 / kN, waves.slope2(), 0.05 * waves.slope2());
  // Cox and Munk's total at this wind.
  EXPECT_NEAR(waves.slope2() + waves.fine_slope2(), 0.003 + 0.00512 * 7.0, 0.012);
}

TEST(SeaWaves, TravelWithTheWindAtDeepWatersSpeed) {
  const SeaWaves waves(kSea);
  Vec2 mean(0.0);
  for (const SeaWave& wave : waves.waves()) {
    const double k = glm::length(wave.wave_number_m);
    EXPECT_NEAR(wave.angular_s * wave.angular_s, 9.81 * k + 7.16e-5 * k * k * k, 1e-9 * 9.81 * k);
    // The same angle a moment later lies further along the wave number.
    const Vec2 step = wave.wave_number_m * (wave.angular_s * 0.1 / (k * k));
    EXPECT_NEAR(SeaWaves::angle_rad(wave, step.x, step.y, 0.1), SeaWaves::angle_rad(wave, 0, 0, 0),
                1e-9);
    mean += 0.5 * wave.amplitude_m * wave.amplitude_m * wave.wave_number_m / k;
  }
  EXPECT_NEAR(std::atan2(mean.x, -mean.y), kSea.direction_rad, 0.25);
}

TEST(SeaWaves, SlopeAndVelocityAreTheHeightsDerivatives) {
  const SeaWaves waves(kSea);
  const double x = 3.2, z = -8.1, t = 5.5, d = 1e-5;
  const Vec2 slope = waves.slope(x, z, t);
  EXPECT_NEAR(slope.x, (waves.height_m(x + d, z, t) - waves.height_m(x - d, z, t)) / (2 * d), 1e-6);
  EXPECT_NEAR(slope.y, (waves.height_m(x, z + d, t) - waves.height_m(x, z - d, t)) / (2 * d), 1e-6);
  const double rise = (waves.height_m(x, z, t + d) - waves.height_m(x, z, t - d)) / (2 * d);
  EXPECT_NEAR(waves.velocity_m_s({x, 0.0, z}, t).y, rise, 1e-6);
  EXPECT_LT(glm::length(waves.velocity_m_s({x, -200.0, z}, t)), 1e-3);
}

TEST(SeaWaves, AFootprintsMeanIsTheQuadratures) {
  const SeaWaves waves(kSea);
  const Vec2 center(4.0, 9.0), size(6.0, 2.0);
  const double heading = 0.9;
  const Vec2 ahead(std::sin(heading), -std::cos(heading)), aside(-ahead.y, ahead.x);
  double height = 0.0, along = 0.0, along2 = 0.0;
  constexpr int kN = 200;
  for (int i = 0; i < kN; ++i)
    for (int j = 0; j < kN; ++j) {
      const double a = ((i + 0.5) / kN - 0.5) * size.x, b = ((j + 0.5) / kN - 0.5) * size.y;
      const Vec2 p = center + a * ahead + b * aside;
      const double h = waves.height_m(p.x, p.y, 2.0);
      height += h;
      along += a * h;
      along2 += a * a;
    }
  const Vec3 fit = waves.height_and_slopes(center, size, heading, 2.0);
  EXPECT_NEAR(fit.x, height / (kN * kN), 1e-4);
  EXPECT_NEAR(glm::dot(Vec2(fit.y, fit.z), ahead), along / along2, 1e-4);
}

TEST(SeaWaves, ExtremesAreFinite) {
  for (const double wind : {0.0, 1e-3, 60.0})
    for (const double fetch : {1.0, 1e7})
      for (const std::uint32_t n : {0u, 1u, 64u}) {
        const SeaWaves waves(
            {.wind_m_s = wind, .fetch_m = fetch, .direction_rad = 1.0, .components = n, .seed = 1});
        for (const double at : {0.0, 1e7, -4e7}) {
          EXPECT_TRUE(std::isfinite(waves.height_m(at, -at, 1e6)));
          EXPECT_TRUE(std::isfinite(waves.velocity_m_s({at, -1e4, at}, 1e6).y));
        }
        EXPECT_TRUE(std::isfinite(waves.slope2() + waves.fine_slope2()));
        EXPECT_LE(waves.foam_share(), 1.0);
      }
}

TEST(SeaWaves, TheFlowsGradientRateAndHeadAreThoseOfItsVelocity) {
  const SeaWaves waves({.wind_m_s = 9.0, .fetch_m = 2e4, .direction_rad = 0.7});
  constexpr double h = 1e-5, time_s = 3.0;
  for (const Vec3& at : {Vec3(2, -0.4, 5), Vec3(-40, -3, 17), Vec3(0, -20, 0)}) {
    const WaveFlow flow = waves.flow(at, time_s);
    Vec3 turning(0.0);
    for (int j = 0; j < 3; ++j) {
      Vec3 step(0.0);
      step[j] = h;
      const Vec3 there =
          (waves.velocity_m_s(at + step, time_s) - waves.velocity_m_s(at - step, time_s)) / (2 * h);
      EXPECT_LT(glm::distance(flow.gradient_per_s[j], there), 1e-6) << j;
      turning[j] = flow.gradient_per_s[(j + 1) % 3][(j + 2) % 3] -
                   flow.gradient_per_s[(j + 2) % 3][(j + 1) % 3];
    }
    EXPECT_LT(glm::length(turning), 1e-9) << "no eddies";
    EXPECT_NEAR(flow.gradient_per_s[0].x + flow.gradient_per_s[1].y + flow.gradient_per_s[2].z, 0.0,
                1e-9)
        << "no source";
    const Vec3 later =
        (waves.velocity_m_s(at, time_s + h) - waves.velocity_m_s(at, time_s - h)) / (2 * h);
    EXPECT_LT(glm::distance(flow.rate_m_s2, later), 1e-6);
  }
  EXPECT_NEAR(waves.flow({2, 0, 5}, time_s).head_m, waves.height_m(2, 5, time_s), 1e-12);
  EXPECT_LT(std::abs(waves.flow({2, -300, 5}, time_s).head_m), 1e-3);
  EXPECT_EQ(SeaWaves().flow({0, -1, 0}, 0.0).head_m, 0.0);
}

}  // namespace
}  // namespace neritic
