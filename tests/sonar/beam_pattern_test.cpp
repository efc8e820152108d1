// Beam patterns against their textbook widths and side lobes.
#include "sonar/beam_pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/math.hpp"

namespace neritic {
namespace {

using sonar::BeamPattern;
using sonar::BeamShape;

// The greatest response off the axis between two u, in dB one way, and where.
std::pair<double, double> side_lobe(BeamShape kind, double from, double to) {
  double highest = 0.0, at = 0.0;
  for (double u = from; u < to; u += 1e-5)
    if (std::abs(sonar::beam_response(kind, u)) > highest)
      highest = std::abs(sonar::beam_response(kind, u)), at = u;
  return {20.0 * std::log10(highest), at};
}

constexpr BeamShape kClosedForms[] = {BeamShape::kSinc, BeamShape::kHamming, BeamShape::kPiston};

TEST(SonarBeamPattern, UniformLineHasTheTextbookWidthAndSideLobe) {
  EXPECT_NEAR(sonar::half_power_u(BeamShape::kSinc), 0.4429464706894523, 1e-12);
  const auto [level_db, u] = side_lobe(BeamShape::kSinc, 1.0, 2.0);
  EXPECT_NEAR(level_db, -13.26146, 1e-5);
  EXPECT_NEAR(u, 1.4303, 5e-5);
  const auto line = *BeamPattern::of_length(BeamShape::kSinc, 100.0);
  const double theta = std::asin(u / 100.0);
  EXPECT_NEAR(10 * std::log10(line.two_way_power(theta)), -26.52, 0.005);
  EXPECT_LT(line.amplitude(theta), 0.0);  // of opposite phase
  EXPECT_NEAR(line.second_null_rad(), std::asin(0.02), 1e-12);
  EXPECT_NEAR(line.amplitude(line.second_null_rad()), 0.0, 1e-12);
}

TEST(SonarBeamPattern, PistonHasTheTextbookWidthAndSideLobe) {
  EXPECT_NEAR(kPi * sonar::half_power_u(BeamShape::kPiston), 1.61634, 1e-5);
  const auto piston = *BeamPattern::of_length(BeamShape::kPiston, 20.0);
  const auto [level_db, u] = side_lobe(BeamShape::kPiston, 1.22, 2.23);
  EXPECT_NEAR(level_db, -17.5702, 5e-4);
  EXPECT_NEAR(kPi * u, 5.1356, 5e-4);
  EXPECT_NEAR(piston.amplitude(piston.second_null_rad()), 0.0, 1e-5);
  EXPECT_NEAR(piston.amplitude(std::asin(3.8317 / kPi / 20.0)), 0.0, 1e-5);  // J1's first zero
}

TEST(SonarBeamPattern, HammingLineIsTheTransformOfItsWeights) {
  const auto line = *BeamPattern::of_length(BeamShape::kHamming, 10.0);
  for (const double theta : {0.0, 0.01, 0.1, 0.2, 0.5, 1.0, 1.5}) {
    const double u = 10.0 * std::sin(theta);
    double sum = 0.0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double x = (i + 0.5) / n - 0.5;
      sum += (0.54 + 0.46 * std::cos(2 * kPi * x)) * std::cos(2 * kPi * u * x) / n;
    }
    EXPECT_NEAR(line.amplitude(theta), sum / 0.54, 1e-7) << theta;
  }
  EXPECT_NEAR(sonar::half_power_u(BeamShape::kHamming) * 2, 1.30, 0.005);  // Harris 1978, table I
  double highest = 0.0;
  for (double u = 2.0; u < 10.0; u += 1e-3)
    highest = std::max(highest, std::abs(sonar::beam_response(BeamShape::kHamming, u)));
  EXPECT_NEAR(20 * std::log10(highest), -42.7, 0.3);
}

TEST(SonarBeamPattern, AWidthIsWhereHalfThePowerIsLeft) {
  for (const BeamShape kind : kClosedForms) {
    const auto pattern = *BeamPattern::of_half_power_width(kind, 0.3);
    EXPECT_NEAR(pattern.half_power_width_rad(), 0.3, 1e-9) << sonar::name_of(kind);
  }
  // -3.0103 dB lies 1 + 0.0103 / 3 degrees out to the right, 3.0103 / 6 * 4 to the left.
  const auto lopsided = *BeamPattern::of_table({{-4, -6}, {0, 0}, {1, -3}, {2, -6}, {9, 0}});
  EXPECT_NEAR(degrees(lopsided.half_power_width_rad()), 1.00343 + 2.00687, 1e-4);
  // A pattern that never falls so far ends with its table; levels count from the axis.
  EXPECT_NEAR(degrees(BeamPattern::of_table({{-5, -1}, {5, -1}})->half_power_width_rad()), 10.0,
              1e-9);
  EXPECT_NEAR(degrees(BeamPattern::of_table({{0, -20}, {6, -26.0206}})->half_power_width_rad()),
              6.0, 1e-4);
}

TEST(SonarBeamPattern, WidthsAreSolvedExactly) {
  for (const BeamShape kind : kClosedForms)
    for (const double width_deg : {0.1, 0.6, 2.0, 12.0, 25.0, 60.0, 120.0, 179.0}) {
      const auto pattern = BeamPattern::of_half_power_width(kind, radians(width_deg));
      ASSERT_TRUE(pattern.ok());
      EXPECT_NEAR(std::pow(pattern->amplitude(radians(width_deg / 2)), 2), 0.5, 1e-9) << width_deg;
    }
}

TEST(SonarBeamPattern, IsOneOnTheAxisEvenBaffledAndNeverLouder) {
  for (const BeamShape kind : kClosedForms)
    for (const double length : {0.001, 0.4, 1.0, 7.5, 1000.0}) {
      const auto pattern = *BeamPattern::of_length(kind, length);
      EXPECT_EQ(pattern.amplitude(0.0), 1.0);
      for (double theta = 0.0; theta <= kPi; theta += 0.01) {
        EXPECT_EQ(pattern.amplitude(theta), pattern.amplitude(-theta));
        EXPECT_LE(std::abs(pattern.amplitude(theta)), 1.0);
        if (theta > kPi / 2) {
          EXPECT_EQ(pattern.amplitude(theta), 0.0);
        }
      }
    }
  const auto shortest = *BeamPattern::of_length(BeamShape::kSinc, 0.3);
  EXPECT_EQ(shortest.second_null_rad(), kPi / 2);  // too short to have one
  EXPECT_TRUE(std::isnan(shortest.amplitude(std::nan(""))));
}

TEST(SonarBeamPattern, SteeredBeamsWidenAsOneOverTheCosine) {
  const auto line = *BeamPattern::of_length(BeamShape::kSinc, 100.0);
  for (const double steer_deg : {0.0, 30.0, 60.0}) {
    const double steer = radians(steer_deg), offset = 0.4429464706894523 / 100.0;
    EXPECT_EQ(line.steered_amplitude(steer, steer), 1.0);
    const double upper = std::asin(std::sin(steer) + offset);
    EXPECT_NEAR(std::pow(line.steered_amplitude(upper, steer), 2), 0.5, 1e-9);
    EXPECT_NEAR((upper - steer) * std::cos(steer), offset, 5e-5);
  }
}

TEST(SonarBeamPattern, RefusesWhatIsNoBeam) {
  EXPECT_FALSE(BeamPattern::of_length(BeamShape::kSinc, 0.0).ok());
  EXPECT_FALSE(BeamPattern::of_length(BeamShape::kSinc, std::nan("")).ok());
  EXPECT_FALSE(BeamPattern::of_half_power_width(BeamShape::kSinc, kPi).ok());
  EXPECT_FALSE(BeamPattern::of_half_power_width(BeamShape::kTable, 0.1).ok());
}

TEST(SonarBeamPattern, TablesAreInterpolatedAndMirrored) {
  const auto beam = BeamPattern::of_table({{0, 0}, {1, -3.0103}, {2, -20}, {3, -12}, {4, -30}});
  ASSERT_TRUE(beam.ok()) << beam.error().message;
  EXPECT_NEAR(beam->two_way_power(radians(1.0)), 0.25, 1e-5);
  EXPECT_NEAR(beam->two_way_power(radians(-1.0)), 0.25, 1e-5);
  EXPECT_NEAR(20 * std::log10(beam->amplitude(radians(-3.5))), -21.0, 1e-9);
  EXPECT_EQ(beam->amplitude(radians(4.1)), 0.0);
  EXPECT_NEAR(degrees(beam->second_null_rad()), 4.0, 1e-12);
  EXPECT_NEAR(20 * std::log10(beam->steered_amplitude(radians(63), radians(60))), -12.0, 1e-9);
  EXPECT_FALSE(BeamPattern::of_table({{0, 1}}).ok());             // louder than the axis
  EXPECT_FALSE(BeamPattern::of_table({{-9, -1}, {-3, 0}}).ok());  // leaves the axis out
  EXPECT_FALSE(BeamPattern::of_table({}).ok());
}

}  // namespace
}  // namespace neritic
