// CNS, OTU, and limits by gas and depth: published values, closed forms against sums.
#include "diver/oxygen_exposure.hpp"

#include <gtest/gtest.h>

#include "diver/deco_live.hpp"
#include "diver/gas_label.hpp"
#include "tests/diver/deco_cases.hpp"

namespace neritic::diver {
namespace {

TEST(OxygenExposure, LimitsAreThoseOfTheTable) {
  const std::pair<double, double> table[] = {{0.6, 720}, {0.7, 570}, {0.8, 450}, {0.9, 360},
                                             {1.0, 300}, {1.1, 240}, {1.2, 210}, {1.3, 180},
                                             {1.4, 150}, {1.5, 120}, {1.6, 45}};
  for (const auto& [po2, minutes] : table) EXPECT_NEAR(cns_limit_min(po2), minutes, 1e-9) << po2;
  EXPECT_NEAR(cns_limit_min(1.45), 135.0, 1e-9);
  EXPECT_TRUE(std::isinf(cns_limit_min(0.5)));
  EXPECT_EQ(cns_limit_min(3.0), 1.0);
}

TEST(OxygenExposure, OtuAreThePublishedOnes) {
  EXPECT_NEAR(oxygen_exposure(1.484, 1.484, 22.0).otu, 38.676, 5e-4);
  EXPECT_NEAR(oxygen_exposure(1.6, 1.6, 20.0).otu, 38.582, 5e-4);
}

// Down to 36.576 m of fresh water in 3 min, 22 min there, up in 30, on EAN32; NOAA's table alone.
TEST(OxygenExposure, ADivesShareIsThePublishedOne) {
  const double surface = 0.32 * kStandardSurface_bar,
               bottom = 0.32 * (kStandardSurface_bar + 36.576 * bar_per_m_of(1000.0));
  double cns = 0.0;
  for (const auto& [from, to, minutes] :
       {std::tuple{surface, bottom, 3.0}, {bottom, bottom, 22.0}, {bottom, surface, 30.0}})
    cns += oxygen_exposure(from, to, minutes, kCnsFromTable_bar).cns_percent;
  EXPECT_NEAR(cns, 26.80, 0.005);
  EXPECT_NEAR(cns_after(cns, 90.0), 0.5 * cns, 1e-12);
}

TEST(OxygenExposure, ClosedFormsAreWhatSumsTendTo) {
  for (const auto& [from, to] : {std::pair{0.21, 1.55},
                                 {1.9, 0.3},
                                 {1.2, 1.2000000001},
                                 {0.9, 1.0},
                                 {1.65, 1.69},
                                 {0.1, 0.45}}) {
    for (const double least : {kCnsFrom_bar, kCnsFromTable_bar}) {
      const OxygenExposure exact = oxygen_exposure(from, to, 10.0, least);
      double cns = 0.0, otu = 0.0;
      constexpr int kParts = 400000;
      for (int i = 0; i < kParts; ++i) {
        const double p = from + (to - from) * (i + 0.5) / kParts;
        if (p > least) cns += 100.0 * 10.0 / kParts / cns_limit_min(p);
        if (p > 0.5) otu += 10.0 / kParts * std::pow((p - 0.5) / 0.5, 5.0 / 6.0);
      }
      EXPECT_NEAR(exact.cns_percent, cns, 2e-5 * cns + 1e-12) << from << " " << to;
      EXPECT_NEAR(exact.otu, otu, 1e-8 + 1e-6 * otu) << from << " " << to;
    }
  }
  EXPECT_EQ(oxygen_exposure(1.4, 1.4, 0.0).cns_percent, 0.0);
}

// Oxygen after a dive: what is gained counts, and nothing declines meanwhile; then air halves it in
// 90 min. The planner's sum over dives and the computer's over samples are one.
TEST(OxygenExposure, AtTheSurfaceTheComputerCountsAsThePlannerDoes) {
  EarlierDive earlier{square_dive(28.0, 60.0, {0.36, 0.0}), 60.0, {1.0, 0.0}};
  std::vector<DivePlan> plans;
  ASSERT_TRUE(tissues_after({earlier}, &plans).ok());
  const OxygenExposure left = oxygen_after({earlier}, plans);
  EXPECT_NEAR(left.cns_percent, plans[0].oxygen.cns_percent + 100.0 * 60.0 / cns_limit_min(1.01325),
              1e-9);
  auto gases = earlier.dive.gases;
  gases.push_back({{1.0, 0.0}, 6.0, GasRole::kDeco});
  const auto computer = DiveComputer::create(
      {earlier.dive.conventions, earlier.dive.gf_low, earlier.dive.gf_high, gases, {}});
  ASSERT_TRUE(computer.ok());
  for (const double step_s : {1.0, 60.0, 3600.0}) {
    DiveComputerState state = computer->start();
    state.oxygen = plans[0].oxygen;
    state = computer->step(state, {0.0, 1}, 0.0);
    for (double s = 0.0; s < 3600.0; s += step_s) state = computer->step(state, {0.0, 1}, step_s);
    EXPECT_NEAR(state.oxygen.cns_percent, left.cns_percent, 1e-9) << step_s;
    EXPECT_NEAR(state.oxygen.otu, left.otu, 1e-9) << step_s;
    state = computer->step(state, {0.0, 0}, 0.0);
    for (double s = 0.0; s < 5400.0; s += 60.0) state = computer->step(state, {0.0, 0}, 60.0);
    EXPECT_NEAR(state.oxygen.cns_percent, 0.5 * left.cns_percent, 1e-9) << step_s;
  }
}

TEST(GasLimits, AreThePublishedOnes) {
  const GasMix ean32{0.32, 0.0}, ean36{0.36, 0.0}, ean50{0.5, 0.0}, tx1845{0.18, 0.45},
      tx1070{0.10, 0.70};
  const DecoEnvironment& simple = kTenMetresABar;
  EXPECT_NEAR(max_operating_depth_m(kAir, 1.4, simple), 56.6667, 1e-4);
  EXPECT_NEAR(max_operating_depth_m(ean32, 1.4, simple), 33.75, 1e-9);
  EXPECT_NEAR(max_operating_depth_m(ean32, 1.4, DecoEnvironment{}), 33.66800200300451, 1e-9);
  EXPECT_NEAR(max_operating_depth_m(ean50, 1.6, simple), 22.0, 1e-9);
  EXPECT_NEAR(air_depth_m(ean32, 30.0, simple), 24.430379746835442, 1e-9);
  EXPECT_NEAR(air_depth_m(ean36, 28.0, simple), 20.78481012658228, 1e-9);
  EXPECT_NEAR(narcotic_depth_m(tx1845, 60.0, simple), 28.5, 1e-9);
  EXPECT_NEAR(air_depth_m(tx1845, 60.0, simple), 22.784810126582272, 1e-9);
  EXPECT_NEAR(narcotic_depth_m(tx1070, 120.0, simple), 29.0, 1e-9);
  EXPECT_NEAR(air_depth_m(tx1070, 120.0, simple), 22.91139240506329, 1e-9);
  EXPECT_NEAR(narcotic_depth_m(kAir, 40.0, simple), 40.0, 1e-9);
  EXPECT_NEAR(gas_density_g_l(kAir, 4.0), 5.152, 5e-4);
  EXPECT_NEAR(gas_density_g_l(kAir, 5.0), 6.440, 5e-4);
  EXPECT_NEAR(gas_density_g_l(tx1845, 7.0), 5.603, 3e-3);
}

TEST(GasLabel, NamesAreReadAndWritten) {
  const std::pair<const char*, const char*> names[] = {
      {"air", "air"},     {"AIR", "air"},       {"ean32", "EAN32"}, {"nx36", "EAN36"},
      {"32", "EAN32"},    {"21", "air"},        {"o2", "O2"},       {"100", "O2"},
      {"18/45", "18/45"}, {"tx10/70", "10/70"}, {"EAN50", "EAN50"}, {"20.9", "EAN20.9"}};
  for (const auto& [text, name] : names) {
    const auto mix = parse_mix(text);
    ASSERT_TRUE(mix.ok()) << text;
    EXPECT_EQ(name_of(*mix), name) << text;
    EXPECT_EQ(*parse_mix(name), *mix) << text;
  }
  for (const char* bad : {"", "ean", "0", "60/50", "18/", "/45", "18/45/2", "nan", "inf", "-5",
                          "water", "18/-1", "1e400"})
    EXPECT_FALSE(parse_mix(bad).ok()) << bad;
  EXPECT_EQ(parse_mix("water").error().message,
            "found gas 'water'; accepted: air, o2, ean32 (1 to 100) or 18/45 (oxygen/helium)");
}

}  // namespace
}  // namespace neritic::diver
