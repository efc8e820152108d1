// Sound speed, absorption, the sonar equation, materials and TVG against published formulas' values
// (printed by an independent program from the same papers) and closed forms.
#include "sonar/acoustics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/files.hpp"
#include "engine/core/math.hpp"
#include "sonar/acoustics_materials.hpp"
#include "sonar/levels.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using sonar::AbsorptionModel;
using sonar::Water;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(SonarSoundSpeed, IsMackenziesToAllDigits) {
  struct Row {
    double t, s, d, mackenzie;
  };
  for (const Row& r :
       {Row{25, 35, 1000, 1550.7440}, Row{10, 35, 0, 1489.8034}, Row{0, 35, 0, 1448.9600},
        Row{4, 35, 100, 1468.1222}, Row{15, 35, 10, 1506.8552}, Row{20, 38.5, 50, 1526.2511},
        Row{27, 35, 10, 1539.0866}, Row{2, 35, 8000, 1598.3207}}) {
    const Water water{r.t, r.s, r.d, 8.0};
    EXPECT_NEAR(sonar::sound_speed_mackenzie_m_s(water), r.mackenzie, 5.1e-5);
  }
}

double db_km(AbsorptionModel model, double f_khz, double t, double d, double s = 35,
             double ph = 8) {
  return 1e3 * sonar::absorption_db_m(model, {t, s, d, ph}, f_khz * 1e3);
}

TEST(SonarAbsorption, IsFrancoisGarrisonsAndAinslieMcColmsToAllDigits) {
  struct Row {
    double khz, fg10, am10, fg20, am20, fg4_1000m, am4_1000m;
  };
  for (const Row& r : {Row{10, .956, .980, .733, .749, 1.005, 1.010},
                       Row{50, 15.283, 15.585, 12.904, 12.982, 13.130, 13.098},
                       Row{100, 33.400, 34.075, 37.791, 38.550, 24.092, 24.017},
                       Row{300, 72.753, 75.683, 101.316, 106.461, 60.123, 60.741},
                       Row{500, 124.178, 131.455, 145.885, 154.207, 122.779, 124.976},
                       Row{750, 221.707, 237.465, 217.943, 230.820, 244.331, 249.631},
                       Row{900, 298.629, 321.104, 273.185, 289.451, 340.513, 348.272},
                       Row{1200, 494.205, 533.776, 412.467, 437.190, 585.277, 599.297},
                       Row{2250, 1618.059, 1755.929, 1209.080, 1281.900, 1992.479, 2042.504}}) {
    using enum AbsorptionModel;
    EXPECT_NEAR(db_km(kFrancoisGarrison, r.khz, 10, 50), r.fg10, 5.1e-4) << r.khz;
    EXPECT_NEAR(db_km(kAinslieMcColm, r.khz, 10, 50), r.am10, 5.1e-4) << r.khz;
    EXPECT_NEAR(db_km(kFrancoisGarrison, r.khz, 20, 50), r.fg20, 5.1e-4) << r.khz;
    EXPECT_NEAR(db_km(kAinslieMcColm, r.khz, 20, 50), r.am20, 5.1e-4) << r.khz;
    EXPECT_NEAR(db_km(kFrancoisGarrison, r.khz, 4, 1000), r.fg4_1000m, 5.1e-4) << r.khz;
    EXPECT_NEAR(db_km(kAinslieMcColm, r.khz, 4, 1000), r.am4_1000m, 5.1e-4) << r.khz;
  }
}

TEST(SonarAbsorption, IsNearPublishedFiguresOfOthers) {
  // 100 kHz, 14 C, 38.5 psu, pH 8.1: 40, 30 and 16 dB/km at 0, 2000 and 6000 m.
  using enum AbsorptionModel;
  EXPECT_NEAR(db_km(kFrancoisGarrison, 100, 14, 0, 38.5, 8.1), 39.869, 5e-4);
  EXPECT_NEAR(db_km(kFrancoisGarrison, 100, 14, 2000, 38.5, 8.1), 29.836, 5e-4);
  EXPECT_NEAR(db_km(kFrancoisGarrison, 100, 14, 6000, 38.5, 8.1), 16.194, 5e-4);
  EXPECT_NEAR(db_km(kFrancoisGarrison, 900, 10, 5, 0.05, 7.0), 251.775, 5e-4);  // fresh water
  // Depth enters the water term divided by 17: without that it is 151.5.
  EXPECT_NEAR(db_km(kAinslieMcColm, 900, 4, 1000), 348.3, 0.05);
}

TEST(SonarAbsorption, IsFiniteAndPositiveOverTheWholeRangeOfWaterAndFrequency) {
  for (const auto model : {AbsorptionModel::kFrancoisGarrison, AbsorptionModel::kAinslieMcColm})
    for (const double t : {-4.0, 0.0, 20.0, 20.0001, 60.0})
      for (const double s : {0.0, 35.0, 60.0})
        for (const double d : {0.0, 11000.0, 12000.0})
          for (const double ph : {6.0, 8.0, 10.0}) {
            ASSERT_TRUE(sonar::validate(Water{t, s, d, ph}).ok());
            double before = 0.0;
            for (double f = 1.0; f <= 1e7; f *= 10.0) {
              const double a = sonar::absorption_db_m(model, {t, s, d, ph}, f);
              ASSERT_TRUE(std::isfinite(a) && a > before) << t << ' ' << s << ' ' << d << ' ' << f;
              before = a;
            }
            EXPECT_TRUE(std::isfinite(sonar::sound_speed_mackenzie_m_s({t, s, d, ph})));
          }
  // A wave of 1 Hz loses next to nothing in 10 000 km; one of 10 MHz everything in a metre or two.
  EXPECT_LT(sonar::absorption_db_m(AbsorptionModel::kFrancoisGarrison, {}, 1.0), 1e-8);
  EXPECT_NEAR(sonar::absorption_db_m(AbsorptionModel::kFrancoisGarrison, {}, 1e7), 31.1, 0.3);
}

TEST(SonarAbsorption, RefusesWhatIsNoWaterAndPassesNaNOn) {
  const auto refused = sonar::validate(Water{10, 35, -1, 8});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "water: depth: found -1 m; accepted: 0 to 12000");
  EXPECT_FALSE(sonar::validate(Water{kNaN, 35, 0, 8}).ok());
  EXPECT_FALSE(sonar::validate(Water{10, 61, 0, 8}).ok());
  EXPECT_FALSE(sonar::validate(Water{10, 35, 0, 14}).ok());
  for (const auto model : {AbsorptionModel::kFrancoisGarrison, AbsorptionModel::kAinslieMcColm}) {
    EXPECT_TRUE(std::isnan(sonar::absorption_db_m(model, {kNaN, 35, 0, 8}, 1e5)));
    EXPECT_TRUE(std::isnan(sonar::absorption_db_m(model, {}, kNaN)));
    EXPECT_TRUE(std::isnan(sonar::absorption_db_m(model, {}, 0.0)));
    EXPECT_TRUE(std::isnan(sonar::absorption_db_m(model, {}, -5.0)));
  }
}

TEST(SonarEquation, GivesTheWorkedValues) {
  EXPECT_NEAR(sonar::two_way_loss_db(10.0, 0.3), 46.0, 1e-12);
  EXPECT_NEAR(sonar::transmission_loss_db(100.0, 0.0), 40.0, 1e-12);
  EXPECT_NEAR(sonar::band_level_db(30.0, 1e4), 70.0, 1e-12);
  // Point blank: 1 mm stands for anything nearer, NaN stays NaN.
  EXPECT_NEAR(sonar::two_way_loss_db(0.0, 0.3), -120.0, 1e-12);
  EXPECT_NEAR(sonar::spherical_spreading_db(0.05), -26.0206, 1e-4);
  EXPECT_TRUE(std::isnan(sonar::two_way_loss_db(kNaN, 0.3)));
}

TEST(SonarEquation, DecibelsRoundTripAndAdd) {
  EXPECT_NEAR(sonar::db_from_power(2.0), 3.0103, 1e-4);
  EXPECT_NEAR(sonar::power_from_db(sonar::db_from_power(1.7e-9)), 1.7e-9, 1e-22);
  EXPECT_NEAR(sonar::amplitude_from_db(20.0 * std::log10(3.2)), 3.2, 1e-14);
  EXPECT_EQ(sonar::db_from_power(0.0), -kInf);
  EXPECT_EQ(sonar::power_from_db(-kInf), 0.0);
  const double equal[] = {60.0, 60.0};
  EXPECT_NEAR(sonar::incoherent_sum_db(equal), 63.0103, 1e-4);
  const double huge[] = {4000.0, 3990.0, -kInf};  // powers beyond double
  EXPECT_NEAR(sonar::incoherent_sum_db(huge), 4000.0 + 10.0 * std::log10(1.1), 1e-9);
  EXPECT_EQ(sonar::incoherent_sum_db({}), -kInf);
  const double with_nan[] = {60.0, kNaN};
  EXPECT_TRUE(std::isnan(sonar::incoherent_sum_db(with_nan)));
}

TEST(SonarEquation, NoiseIsThermalAtHighFrequenciesAndWindBorneBelow) {
  EXPECT_NEAR(sonar::thermal_noise_db(1e5), 25.0, 1e-12);
  EXPECT_NEAR(sonar::ambient_noise_db(1e6, 5.0, 0.5), 45.0, 0.05);
  // 1 kHz, calm: 50 + 0 - 40 log 1.4 of wind's term, the others below.
  EXPECT_NEAR(sonar::ambient_noise_db(1e3, 0.0, 0.0), 44.37, 0.3);
  EXPECT_GT(sonar::ambient_noise_db(1e4, 10.0, 0.5), sonar::ambient_noise_db(1e4, 2.0, 0.5) + 10.0);
  EXPECT_GT(sonar::ambient_noise_db(100.0, 0.0, 1.0),
            sonar::ambient_noise_db(100.0, 0.0, 0.0) + 15);
  EXPECT_TRUE(std::isfinite(sonar::ambient_noise_db(1.0, 0.0, 0.5)));
  EXPECT_TRUE(std::isfinite(sonar::ambient_noise_db(1e7, 30.0, 0.5)));
  EXPECT_TRUE(std::isnan(sonar::ambient_noise_db(0.0, 1.0, 0.5)));
}

TEST(SonarReflection, MaterialsReflectAsPublished) {
  const auto r = [](const char* name) {
    return sonar::reflection_coefficient(sonar::kReferenceWater, *sonar::material_of(name));
  };
  EXPECT_NEAR(r("steel"), 0.9382, 5e-5);
  EXPECT_NEAR(r("aluminium"), 0.8431, 5e-5);
  EXPECT_NEAR(r("concrete"), 0.6690, 5e-5);
  EXPECT_NEAR(r("sand"), 0.3941, 5e-5);
  EXPECT_NEAR(r("rubber"), 0.0558, 5e-5);
  EXPECT_NEAR(r("air"), -0.9994, 5e-5);
  EXPECT_EQ(r("water"), 0.0);
  EXPECT_NEAR(sonar::reflection_coefficient({1200, 1600}, {1023, 1540}), -0.0986, 5e-5);
  EXPECT_NEAR(sonar::reflection_coefficient(sonar::kReferenceWater, {3200, 4500}), 0.8141, 5e-5);
  for (const sonar::Material& material : sonar::materials()) {
    EXPECT_LT(std::abs(r(std::string(material.name).c_str())), 1.0) << material.name;
    EXPECT_FALSE(material.source.empty()) << material.name;
  }
  const auto refused = sonar::material_of("stell");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("nearest: steel"), std::string::npos);
}

TEST(SonarLevels, AnEchoIsSourceLessTwoWayLossPlusTargetStrength) {
  scene::SonarLevel level;
  level.source_level_db = 210.0;
  const auto db = [&](double r) {
    return sonar::db_from_power(sonar::echo_power(level, r, 0.3, 0.01, 0.1));
  };
  // Strength and solid angle are -30 dB, the area grows by 20 log r: -10 dB at 10 m.
  EXPECT_NEAR(db(10.0), 210.0 - 46.0 - 10.0, 1e-9);
  level.spreading = false;
  EXPECT_NEAR(db(10.0), 210.0 - 6.0 - 10.0, 1e-9);
  EXPECT_EQ(sonar::echo_power(level, 10.0, 0.3, 0.0, 0.1), 0.0);
  EXPECT_TRUE(std::isfinite(sonar::echo_power(level, 0.0, 1000.0, 1e2, 1.0)));
}

TEST(SonarLevels, TimeVariedGainLevelsPointTargetsExactly) {
  scene::SonarLevel level;
  level.tvg_log = 40.0;
  level.tvg_absorption = true;
  for (const double r : {0.05, 1.0, 10.0, 10000.0})
    EXPECT_NEAR(sonar::receiver_gain_db(level, r, 0.3) - sonar::two_way_loss_db(r, 0.3), 0.0, 1e-9)
        << r;
  EXPECT_TRUE(std::isfinite(sonar::receiver_gain_db(level, 0.0, 0.3)));
  level = {.tvg_log = 30.0, .gain_db = -6.0};
  EXPECT_NEAR(sonar::receiver_gain_db(level, 10.0, 0.3), 24.0, 1e-12);
  level = {.tvg_table = {{1.0, 0.0}, {10.0, 20.0}}};
  EXPECT_EQ(sonar::receiver_gain_db(level, 0.5, 0.3), 0.0);
  EXPECT_NEAR(sonar::receiver_gain_db(level, 5.5, 0.3), 10.0, 1e-12);
  EXPECT_EQ(sonar::receiver_gain_db(level, 1e5, 0.3), 20.0);
}

TEST(SonarLevels, NoiseIsWhatIsNamedOrAmbientAndSelfAdded) {
  scene::SonarTerms terms;
  terms.frequency_hz = 100e3;
  terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 20e3};
  terms.noise = scene::SonarNoise{.level_db = 71.0};
  EXPECT_EQ(sonar::noise_level_db(terms), 71.0);
  // Wind of 10 m/s and shipping 0.5 at 100 kHz, by hand: 17 - 60 = -43; 40 + 52 - 120.01 = -28.01;
  // 50 + 23.717 + 40 - 80.069 = 33.648; thermal 25; together 34.204 dB re 1 uPa^2/Hz; 20 kHz of it
  // 43.010 dB more.
  terms.noise = scene::SonarNoise{.wind_m_s = 10.0, .shipping = 0.5};
  EXPECT_NEAR(sonar::noise_level_db(terms), 77.2139, 0.002);
  terms.noise->self_db = 77.2139;
  EXPECT_NEAR(sonar::noise_level_db(terms), 80.2242, 0.002);
  // A receiver hears less of what comes from all around, and all of its own.
  terms.noise->directivity_db = 20.0;
  EXPECT_NEAR(sonar::noise_level_db(terms), 77.2139 + 0.0432, 0.002);
}

TEST(SonarLevels, WhatIsBelowItsRowsFloorIsSilence) {
  const std::vector<float> floor{1e7f, 4e7f};
  const std::vector<float> image{2e7f, 1e6f, 5e7f, 2e7f, 1e6f, 5e7f};
  EXPECT_EQ(sonar::above_floor(image, floor), (std::vector<float>{2e7f, 0, 5e7f, 0, 0, 5e7f}));
  EXPECT_EQ(sonar::above_floor(image, {}), image);
}

}  // namespace
}  // namespace neritic
