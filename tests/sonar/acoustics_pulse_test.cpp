// Range point spread: envelopes against their textbook side lobes, energies against numerical
// integrals, kernels that keep the energy.
#include "sonar/acoustics_pulse.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace neritic {
namespace {

using sonar::PulseShape;

double peak_db(PulseShape shape, double from, double to) {
  double highest = 0.0;
  for (double x = from; x < to; x += 1e-4)
    highest = std::max(highest, std::abs(sonar::pulse_envelope(shape, x, 1.0)));
  return 20.0 * std::log10(highest);
}

TEST(SonarPulse, ResolutionAndSideLobesAreTheTextbooks) {
  EXPECT_NEAR(sonar::range_resolution_m(1500.0, 29.9e3), 0.0250836, 5e-8);
  for (const auto shape : {PulseShape::kFlat, PulseShape::kHann})
    EXPECT_EQ(sonar::pulse_envelope(shape, 0.0, 0.025), 1.0);
  EXPECT_NEAR(peak_db(PulseShape::kFlat, 1.0, 2.0), -13.26, 0.005);
  EXPECT_NEAR(peak_db(PulseShape::kHann, 2.0, 3.0), -31.47, 0.005);
  EXPECT_NEAR(sonar::pulse_envelope(PulseShape::kFlat, 0.44295, 1.0), std::sqrt(0.5), 1e-5);
  // Hann's is 1.44 times c / 2B from half power to half power (Harris 1978, table 1: 1.44 bins).
  EXPECT_NEAR(sonar::pulse_envelope(PulseShape::kHann, 0.7203, 1.0), std::sqrt(0.5), 1e-4);
  EXPECT_NEAR(sonar::pulse_envelope(PulseShape::kFlat, 0.025, 0.025), 0.0, 1e-15);
  EXPECT_NEAR(sonar::pulse_envelope(PulseShape::kHann, 2.0, 1.0), 0.0, 1e-15);
  EXPECT_NEAR(sonar::pulse_envelope(PulseShape::kHann, 1.0, 1.0), 0.5, 1e-12);
}

TEST(SonarPulse, EnergyIsTheIntegralOfTheSquaredEnvelope) {
  for (const auto shape : {PulseShape::kFlat, PulseShape::kHann}) {
    // Simpson from 0; the whole is 1 (flat) or 3/2 (Hann) resolutions, by Parseval.
    const double whole = shape == PulseShape::kFlat ? 1.0 : 1.5;
    const double step = 1e-3;
    double sum = 0.0;
    const auto power = [&](double x) { return std::pow(sonar::pulse_envelope(shape, x, 1.0), 2); };
    for (int i = 0; i < 20000; ++i) {
      const double x = i * step;
      sum += step / 6 * (power(x) + 4 * power(x + step / 2) + power(x + step));
      if (i % 97 != 0) continue;
      EXPECT_NEAR(sonar::pulse_energy_below(shape, x + step, 1.0), 0.5 + sum / whole, 1e-10) << x;
      EXPECT_NEAR(sonar::pulse_energy_below(shape, -x - step, 1.0), 0.5 - sum / whole, 1e-10);
    }
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(sonar::pulse_energy_below(shape, inf, 1.0), 1.0);
    EXPECT_EQ(sonar::pulse_energy_below(shape, -inf, 1.0), 0.0);
  }
  // sinc^2's tail is 1 / (2 pi^2 x) each side.
  EXPECT_NEAR(1.0 - sonar::pulse_energy_below(PulseShape::kFlat, 1e5, 1.0),
              1.0 / (2 * M_PI * M_PI * 1e5), 1e-12);
}

TEST(SonarRangeSpread, KeepsTheEnergyWhateverTheBins) {
  for (const auto shape : {PulseShape::kFlat, PulseShape::kHann})
    for (const double bin : {1e-3, 0.01, 0.025, 0.0251, 0.3, 20.0})
      for (const double truncated : {0.1, 1e-2, 1e-3}) {
        const auto spread = sonar::range_spread(shape, 0.025, bin, truncated);
        ASSERT_TRUE(spread.ok()) << spread.error().message;
        ASSERT_EQ(spread->energy.size(), 2 * spread->reach + 1);
        EXPECT_LE(spread->truncated, truncated);
        EXPECT_NEAR(std::reduce(spread->energy.begin(), spread->energy.end()), 1.0, 1e-12);
        for (std::size_t i = 0; i < spread->energy.size(); ++i) {
          ASSERT_GE(spread->energy[i], 0.0);
          EXPECT_NEAR(std::pow(spread->amplitude[i], 2), spread->energy[i], 1e-15);
          EXPECT_EQ(spread->energy[i], spread->energy[spread->energy.size() - 1 - i]);
        }
      }
}

TEST(SonarRangeSpread, IsTheSampledEnvelopeInFineBinsAndOneBinInCoarseOnes) {
  const auto fine = *sonar::range_spread(PulseShape::kFlat, 0.025, 0.0005, 1e-2);
  const double centre = fine.amplitude[fine.reach];
  for (std::uint32_t k = 0; k <= fine.reach; ++k)
    EXPECT_NEAR(fine.amplitude[fine.reach + k] / centre,
                sonar::pulse_envelope(PulseShape::kFlat, k * 0.0005, 0.025), 0.02);
  EXPECT_EQ(sonar::range_spread(PulseShape::kFlat, 0.025, 20.0, 1e-2)->reach, 0u);
  // Hann leaves less beyond a given reach.
  EXPECT_LT(sonar::range_spread(PulseShape::kHann, 0.025, 0.005, 1e-3)->reach,
            sonar::range_spread(PulseShape::kFlat, 0.025, 0.005, 1e-3)->reach);
}

// The envelope's power of points 1/200 of a bin apart, averaged over each bin: no integral in
// closed form.
TEST(SonarRangeSpread, HasTheMeanPowerOfAPointAnywhereInItsBin) {
  constexpr double kResolution_m = 0.02;
  for (const auto shape : {PulseShape::kFlat, PulseShape::kHann})
    for (const double bins_a_pulse : {20.0, 3.0, 1.0, 0.5, 0.1}) {
      const double bin = sonar::pulse_length_m(shape, kResolution_m) / bins_a_pulse;
      const auto spread =
          *sonar::range_spread(shape, kResolution_m, bin, 1e-3, sonar::PlaceInBin::kAnywhere);
      EXPECT_NEAR(spread.pulse_bins, bins_a_pulse, 1e-12);
      EXPECT_NEAR(std::reduce(spread.energy.begin(), spread.energy.end()), 1.0, 1e-12);
      const int reach = static_cast<int>(spread.reach);
      for (int k = 0; k <= std::min(reach, 3); ++k) {
        // Over all pairs of places: a distance d from k - 1 to k + 1 bins has the weight
        // 1 - abs(d - k).
        double mean = 0.0;
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i) {
          const double d = (i + 0.5) / kSteps * 2.0 - 1.0;
          mean += (1.0 - std::abs(d)) *
                  std::pow(sonar::pulse_envelope(shape, (k + d) * bin, kResolution_m), 2) * 2.0 /
                  kSteps;
        }
        const double tap = spread.energy[static_cast<std::size_t>(reach + k)] * spread.pulse_bins;
        EXPECT_NEAR(tap, mean, 2e-3 * mean + 1e-4) << bins_a_pulse << " " << k;
      }
    }
}

// In bins that are short against the pulse it makes no difference where in them a point lies.
TEST(SonarRangeSpread, PlacesInShortBinsAreAlike) {
  const auto middle = *sonar::range_spread(PulseShape::kHann, 0.025, 0.001, 1e-3);
  const auto anywhere =
      *sonar::range_spread(PulseShape::kHann, 0.025, 0.001, 1e-3, sonar::PlaceInBin::kAnywhere);
  ASSERT_EQ(middle.reach, anywhere.reach);
  for (std::size_t i = 0; i < middle.energy.size(); ++i)
    EXPECT_NEAR(anywhere.energy[i] / middle.energy[middle.reach],
                middle.energy[i] / middle.energy[middle.reach], 1e-3);
  EXPECT_NEAR(anywhere.energy[anywhere.reach] * anywhere.pulse_bins, 1.0, 2e-3);
}

TEST(SonarRangeSpread, RefusesWhatIsNoLength) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, nan}) {
    EXPECT_FALSE(sonar::range_spread(PulseShape::kFlat, bad, 0.01).ok());
    EXPECT_FALSE(sonar::range_spread(PulseShape::kFlat, 0.01, bad).ok());
    EXPECT_FALSE(sonar::range_spread(PulseShape::kFlat, 0.01, 0.01, bad).ok());
  }
  EXPECT_FALSE(sonar::range_spread(PulseShape::kFlat, 1.0, 1e-4, 1e-3).ok());  // 1e6 bins
}

}  // namespace
}  // namespace neritic
