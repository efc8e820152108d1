// Beam patterns against their textbook widths and side lobes, and the spread over beams: energy
// kept to the last digits.
#include "sonar/beam_pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/files.hpp"
#include "engine/core/math.hpp"
#include "sonar/beam_spread.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using sonar::BeamKind;
using sonar::BeamPattern;

constexpr BeamKind kClosedForms[] = {BeamKind::kSinc, BeamKind::kHamming, BeamKind::kPiston};

TEST(SonarBeamPattern, UniformLineHasTheTextbookWidthAndSideLobe) {
  EXPECT_NEAR(sonar::half_power_u(BeamKind::kSinc), 0.4429464706894523, 1e-12);
  const auto line = *BeamPattern::of_length(BeamKind::kSinc, 100.0);
  EXPECT_NEAR(line.half_power_width_rad(), 0.8859 / 100.0, 1e-6);
  const auto lobe = line.first_side_lobe();
  ASSERT_TRUE(lobe);
  EXPECT_NEAR(lobe->level_db, -13.26146, 1e-5);
  EXPECT_NEAR(100.0 * std::sin(lobe->angle_rad), 1.4303, 5e-5);
  EXPECT_NEAR(10 * std::log10(line.two_way_power(lobe->angle_rad)), -26.52, 0.005);
  EXPECT_LT(line.amplitude(lobe->angle_rad), 0.0);  // of opposite phase
}

TEST(SonarBeamPattern, PistonHasTheTextbookWidthAndSideLobe) {
  EXPECT_NEAR(kPi * sonar::half_power_u(BeamKind::kPiston), 1.61634, 1e-5);
  const auto piston = *BeamPattern::of_length(BeamKind::kPiston, 20.0);
  const auto lobe = piston.first_side_lobe();
  ASSERT_TRUE(lobe);
  EXPECT_NEAR(lobe->level_db, -17.5702, 5e-4);
  EXPECT_NEAR(kPi * 20.0 * std::sin(lobe->angle_rad), 5.1356, 5e-4);
  EXPECT_NEAR(piston.amplitude(std::asin(3.8317 / kPi / 20.0)), 0.0, 1e-5);  // J1's first zero
}

TEST(SonarBeamPattern, HammingLineIsTheTransformOfItsWeights) {
  const auto line = *BeamPattern::of_length(BeamKind::kHamming, 10.0);
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
  EXPECT_NEAR(sonar::half_power_u(BeamKind::kHamming) * 2, 1.30, 0.005);  // Harris 1978, table I
  double highest = 0.0;
  for (double u = 2.0; u < 10.0; u += 1e-3)
    highest = std::max(highest, std::abs(sonar::beam_response(BeamKind::kHamming, u)));
  EXPECT_NEAR(20 * std::log10(highest), -42.7, 0.3);
}

TEST(SonarBeamPattern, WidthsAreSolvedExactlyAndRoundTrip) {
  for (const BeamKind kind : kClosedForms)
    for (const double width_deg : {0.1, 0.6, 2.0, 12.0, 25.0, 60.0, 120.0, 179.0}) {
      const auto pattern = BeamPattern::of_half_power_width(kind, radians(width_deg));
      ASSERT_TRUE(pattern.ok());
      EXPECT_NEAR(pattern->one_way_power(radians(width_deg / 2)), 0.5, 1e-9) << width_deg;
      EXPECT_NEAR(degrees(pattern->half_power_width_rad()), width_deg, 1e-9);
      const auto same = *BeamPattern::of_length(kind, pattern->length_wavelengths());
      EXPECT_EQ(same.amplitude(0.3), pattern->amplitude(0.3));
    }
  const auto metres = *BeamPattern::of_length(BeamKind::kSinc, 0.1, 750e3, 1500.0);
  EXPECT_NEAR(metres.length_wavelengths(), 50.0, 1e-12);
}

TEST(SonarBeamPattern, IsOneOnTheAxisEvenBaffledAndNeverLouder) {
  for (const BeamKind kind : kClosedForms)
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
  // Too short to have a null, or to fall to one half.
  const auto shortest = *BeamPattern::of_length(BeamKind::kSinc, 0.3);
  EXPECT_EQ(shortest.half_power_width_rad(), kPi);
  EXPECT_FALSE(shortest.first_side_lobe());
  EXPECT_EQ(BeamPattern::omni().amplitude(3.0), 1.0);
  EXPECT_EQ(BeamPattern::omni().half_power_width_rad(), 2 * kPi);
  EXPECT_TRUE(std::isnan(shortest.amplitude(std::nan(""))));
}

TEST(SonarBeamPattern, SteeredBeamsWidenAsOneOverTheCosine) {
  const auto line = *BeamPattern::of_length(BeamKind::kSinc, 100.0);
  for (const double steer_deg : {0.0, 30.0, 60.0}) {
    const double steer = radians(steer_deg), offset = 0.4429464706894523 / 100.0;
    EXPECT_EQ(line.steered_amplitude(steer, steer), 1.0);
    const double upper = std::asin(std::sin(steer) + offset);
    EXPECT_NEAR(std::pow(line.steered_amplitude(upper, steer), 2), 0.5, 1e-9);
    EXPECT_NEAR((upper - steer) * std::cos(steer), offset, 5e-5);
  }
}

TEST(SonarBeamPattern, RefusesWhatIsNoBeam) {
  EXPECT_FALSE(BeamPattern::of_length(BeamKind::kSinc, 0.0).ok());
  EXPECT_FALSE(BeamPattern::of_length(BeamKind::kSinc, std::nan("")).ok());
  EXPECT_FALSE(BeamPattern::of_length(BeamKind::kOmni, 1.0).ok());
  EXPECT_FALSE(BeamPattern::of_half_power_width(BeamKind::kSinc, kPi).ok());
  EXPECT_FALSE(BeamPattern::of_half_power_width(BeamKind::kTable, 0.1).ok());
  EXPECT_EQ(*sonar::beam_kind_of("hamming"), BeamKind::kHamming);
  EXPECT_FALSE(sonar::beam_kind_of("table").ok());
}

TEST(SonarBeamPattern, TablesAreReadInterpolatedAndMirrored) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(
      write_text(folder / "beam.csv", "angle_deg,db\n0,0\n1,-3.0103\n2,-20\n3,-12\n4,-30\n").ok());
  const auto beam = BeamPattern::from_file(folder / "beam.csv");
  ASSERT_TRUE(beam.ok()) << beam.error().message;
  EXPECT_NEAR(beam->one_way_power(radians(1.0)), 0.5, 1e-5);
  EXPECT_NEAR(beam->one_way_power(radians(-1.0)), 0.5, 1e-5);
  EXPECT_NEAR(20 * std::log10(beam->amplitude(radians(-3.5))), -21.0, 1e-9);
  EXPECT_EQ(beam->amplitude(radians(4.1)), 0.0);
  EXPECT_NEAR(degrees(beam->half_power_width_rad()), 2.0, 1e-4);
  const auto lobe = beam->first_side_lobe();
  ASSERT_TRUE(lobe);
  EXPECT_NEAR(degrees(lobe->angle_rad), 3.0, 1e-3);
  EXPECT_NEAR(lobe->level_db, -12.0, 1e-3);
  EXPECT_NEAR(20 * std::log10(beam->steered_amplitude(radians(63), radians(60))), -12.0, 1e-9);
  EXPECT_FALSE(BeamPattern::of_table({{0, 1}}).ok());             // louder than the axis
  EXPECT_FALSE(BeamPattern::of_table({{-9, -1}, {-3, 0}}).ok());  // leaves the axis out
  EXPECT_FALSE(BeamPattern::of_table({}).ok());
}

using sonar::BeamGrid;
using sonar::BeamSpread;
using sonar::Steering;
using sonar::Ways;

// Sums of what all beams take of each column.
void expect_kept(const BeamSpread& spread) {
  std::vector<double> sums(spread.beams, 0.0);
  for (std::int64_t beam = 0; beam < spread.beams; ++beam)
    for (std::int64_t t = 0; t < spread.taps(); ++t) {
      const std::size_t i = beam * spread.taps() + t;
      std::int64_t column = beam + t - spread.reach;
      ASSERT_GE(spread.energy[i], 0.0);
      ASSERT_NEAR(spread.amplitude[i] * spread.amplitude[i], spread.energy[i], 1e-15);
      if (spread.wraps) column = (column + spread.beams) % spread.beams;
      if (column < 0 || column >= spread.beams)
        ASSERT_EQ(spread.energy[i], 0.0);
      else
        sums[column] += spread.energy[i];
    }
  for (const double sum : sums) ASSERT_NEAR(sum, 1.0, 1e-12);
}

TEST(SonarBeamSpread, KeepsEveryColumnsEnergy) {
  for (const std::uint32_t beams : {1u, 2u, 97u, 256u})
    for (const double span_deg : {0.1, 45.0, 130.0, 180.0, 360.0})
      for (const BeamKind kind : kClosedForms)
        for (const auto ways : {Ways::kOneWay, Ways::kTwoWay})
          for (const auto steering : {Steering::kTurned, Steering::kElectronic}) {
            if (steering == Steering::kElectronic && span_deg > 180.0) continue;
            const BeamGrid grid =
                sonar::symmetric_grid(1, 5, radians(span_deg), radians(20), {10, beams, 10});
            const auto pattern = *BeamPattern::of_half_power_width(kind, radians(1.3));
            const auto spread = sonar::beam_spread(pattern, grid, {ways, steering, 1e-2});
            ASSERT_TRUE(spread.ok()) << spread.error().message;
            EXPECT_LE(spread->truncated, 1e-2);
            EXPECT_EQ(spread->wraps, span_deg == 360.0);
            ASSERT_NO_FATAL_FAILURE(expect_kept(*spread))
                << beams << " beams, " << span_deg << " degrees, " << name_of(kind);
          }
}

TEST(SonarBeamSpread, IsThePatternBetweenBeamsMuchFinerThanIt) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(20), radians(20), {10, 801, 10});
  const auto pattern = *BeamPattern::of_half_power_width(BeamKind::kSinc, radians(1));
  const auto spread = *sonar::beam_spread(pattern, grid, {Ways::kOneWay, Steering::kTurned, 0.05});
  const std::size_t row = std::size_t{400} * spread.taps() + spread.reach;
  for (std::uint32_t t = 0; t <= spread.reach; ++t)
    EXPECT_NEAR(spread.amplitude[row + t] / spread.amplitude[row],
                pattern.amplitude(t * grid.azimuth_step_rad()), 0.01);
  EXPECT_LT(spread.amplitude[row + 60], 0.0);  // 1.5 degrees off: the first side lobe
}

TEST(SonarBeamSpread, SteeredBeamsReachFurtherAtTheSides) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(130), radians(20), {10, 521, 10});
  const auto pattern = *BeamPattern::of_half_power_width(BeamKind::kHamming, radians(1));
  const auto spread =
      *sonar::beam_spread(pattern, grid, {Ways::kOneWay, Steering::kElectronic, 1e-3});
  const auto own = [&](std::size_t beam) {
    return spread.energy[beam * spread.taps() + spread.reach];
  };
  // Of beams far enough from the edges that nothing of them is cut off.
  EXPECT_NEAR(own(60) / own(260), std::cos(grid.azimuth_rad(60)), 0.01);
}

TEST(SonarBeamSpread, BeamsNarrowerThanTheirSpacingKeepToThemselves) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(360), radians(20), {10, 400, 10});
  const auto narrow = *BeamPattern::of_half_power_width(BeamKind::kHamming, radians(0.01));
  const auto spread = *sonar::beam_spread(narrow, grid, {});
  EXPECT_EQ(spread.reach, 0u);
  EXPECT_EQ(spread.energy[7], 1.0);
  // And a beam of all directions hears all alike.
  const BeamGrid few = sonar::symmetric_grid(1, 5, radians(90), radians(20), {10, 4, 10});
  const auto all = *sonar::beam_spread(BeamPattern::omni(), few, {});
  EXPECT_EQ(all.reach, 3u);
  EXPECT_NEAR(all.energy[3], 0.25, 1e-15);
}

TEST(SonarBeamSpread, RefusesWhatItCannotHold) {
  const BeamGrid wide = sonar::symmetric_grid(1, 5, radians(360), radians(20), {10, 8192, 10});
  const auto line = *BeamPattern::of_half_power_width(BeamKind::kSinc, radians(1));
  EXPECT_FALSE(sonar::beam_spread(line, wide, {Ways::kOneWay, Steering::kElectronic, 1e-2}).ok());
  EXPECT_FALSE(sonar::beam_spread(line, wide, {Ways::kOneWay, Steering::kTurned, 0.0}).ok());
  EXPECT_FALSE(sonar::beam_spread(BeamPattern::omni(), wide, {}).ok());
}

TEST(SonarElevationPower, FallsToHalfAtTheHalfWidthAndKeepsItsScale) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(40), {10, 10, 400});
  const auto line = *BeamPattern::of_half_power_width(BeamKind::kSinc, radians(20));
  const auto one = sonar::elevation_power(line, grid, Ways::kOneWay);
  const auto two = sonar::elevation_power(line, grid, Ways::kTwoWay);
  ASSERT_EQ(one.size(), 400u);
  EXPECT_NEAR(one[200], 1.0, 1e-4);
  EXPECT_NEAR(0.5 * (one[299] + one[300]), 0.5, 1e-3);  // 10 degrees up
  EXPECT_NEAR(0.5 * (two[299] + two[300]), 0.25, 1e-3);
  // Ten rows are the averages of what four hundred hear.
  const BeamGrid coarse = sonar::symmetric_grid(1, 5, radians(90), radians(40), {10, 10, 10});
  const auto ten = sonar::elevation_power(line, coarse, Ways::kOneWay);
  double mean = 0.0;
  for (int i = 0; i < 40; ++i) mean += one[i] / 40;
  EXPECT_NEAR(ten[0], mean, 1e-3);
  // Tilted down by 10 degrees, the top row lies 30 off.
  const auto down = sonar::elevation_power(line, grid, Ways::kOneWay, radians(-10));
  EXPECT_NEAR(down[100], 1.0, 1e-4);
  EXPECT_NEAR(down[399], line.one_way_power(radians(29.95)), 1e-4);
}

}  // namespace
}  // namespace neritic
