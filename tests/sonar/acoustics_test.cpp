// Sound speed, absorption, the sonar equation, materials and TVG against published formulas' values
// (printed by an independent program from the same papers) and closed forms.
#include "sonar/acoustics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/files.hpp"
#include "engine/core/math.hpp"
#include "sonar/acoustics_materials.hpp"
#include "sonar/acoustics_tvg.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using sonar::AbsorptionModel;
using sonar::Water;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(SonarSoundSpeed, IsMackenziesAndMedwinsToAllDigits) {
  struct Row {
    double t, s, d, mackenzie, medwin;
  };
  for (const Row& r :
       {Row{25, 35, 1000, 1550.7440, 1550.3563}, Row{10, 35, 0, 1489.8034, 1489.9900},
        Row{0, 35, 0, 1448.9600, 1449.2000}, Row{4, 35, 100, 1468.1222, 1468.3386},
        Row{15, 35, 10, 1506.8552, 1506.9638}, Row{20, 38.5, 50, 1526.2511, 1526.3100},
        Row{27, 35, 10, 1539.0866, 1539.1731}, Row{2, 35, 8000, 1598.3207, 1586.1823}}) {
    const Water water{r.t, r.s, r.d, 8.0};
    EXPECT_NEAR(sonar::sound_speed_mackenzie_m_s(water), r.mackenzie, 5.1e-5);
    EXPECT_NEAR(sonar::sound_speed_medwin_m_s(water), r.medwin, 5.1e-5);
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
  EXPECT_EQ(refused.error().message, "water: depth is -1 m, 0 to 12000 is accepted");
  EXPECT_FALSE(sonar::validate(Water{kNaN, 35, 0, 8}).ok());
  EXPECT_FALSE(sonar::validate(Water{10, 61, 0, 8}).ok());
  EXPECT_FALSE(sonar::validate(Water{10, 35, 0, 14}).ok());
  for (const auto model : {AbsorptionModel::kFrancoisGarrison, AbsorptionModel::kAinslieMcColm}) {
    EXPECT_TRUE(std::isnan(sonar::absorption_db_m(model, {kNaN, 35, 0, 8}, 1e5)));
    EXPECT_TRUE(std::isnan(sonar::absorption_db_m(model, {}, kNaN)));
    EXPECT_TRUE(std::isnan(sonar::absorption_db_m(model, {}, 0.0)));
    EXPECT_TRUE(std::isnan(sonar::absorption_db_m(model, {}, -5.0)));
  }
  EXPECT_TRUE(sonar::absorption_model_of("ainslie-mccolm").ok());
  EXPECT_FALSE(sonar::absorption_model_of("thorp").ok());
}

TEST(SonarEquation, GivesTheWorkedValues) {
  EXPECT_NEAR(sonar::two_way_loss_db(10.0, 0.3), 46.0, 1e-12);
  EXPECT_NEAR(sonar::transmission_loss_db(100.0, 0.0), 40.0, 1e-12);
  EXPECT_EQ(sonar::echo_level_db(210.0, 46.0, -26.0), 138.0);
  EXPECT_EQ(sonar::signal_to_noise_db(138.0, 100.0), 38.0);
  EXPECT_NEAR(sonar::band_level_db(30.0, 1e4), 70.0, 1e-12);
  // Point blank: 1 mm stands for anything nearer, NaN stays NaN.
  EXPECT_NEAR(sonar::two_way_loss_db(0.0, 0.3), -120.0, 1e-12);
  EXPECT_NEAR(sonar::spherical_spreading_db(0.05), -26.0206, 1e-4);
  EXPECT_TRUE(std::isnan(sonar::two_way_loss_db(kNaN, 0.3)));
}

TEST(SonarEquation, DecibelsRoundTripAndAdd) {
  EXPECT_NEAR(sonar::db_from_power(2.0), 3.0103, 1e-4);
  EXPECT_NEAR(sonar::db_from_amplitude(0.5), -6.0206, 1e-4);
  EXPECT_NEAR(sonar::power_from_db(sonar::db_from_power(1.7e-9)), 1.7e-9, 1e-22);
  EXPECT_NEAR(sonar::amplitude_from_db(sonar::db_from_amplitude(3.2)), 3.2, 1e-14);
  EXPECT_EQ(sonar::db_from_power(0.0), -kInf);
  EXPECT_EQ(sonar::power_from_db(-kInf), 0.0);
  const double equal[] = {60.0, 60.0};
  EXPECT_NEAR(sonar::incoherent_sum_db(equal), 63.0103, 1e-4);
  const double huge[] = {4000.0, 3990.0, -kInf};  // powers beyond double
  EXPECT_NEAR(sonar::incoherent_sum_db(huge), 4000.0 + 10.0 * std::log10(1.1), 1e-9);
  EXPECT_EQ(sonar::incoherent_sum_db({}), -kInf);
  const double with_nan[] = {60.0, kNaN};
  EXPECT_TRUE(std::isnan(sonar::incoherent_sum_db(with_nan)));
  const double in_phase[] = {0.3, 0.3}, opposed[] = {0.0, kPi};
  EXPECT_NEAR(sonar::db_from_amplitude(std::abs(sonar::coherent_sum(equal, in_phase))), 66.0206,
              1e-4);
  EXPECT_NEAR(std::abs(sonar::coherent_sum(equal, opposed)), 0.0, 1e-12);
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

TEST(SonarTargets, SpheresAndBottomsHaveTheTextbookStrength) {
  EXPECT_NEAR(sonar::rigid_sphere_target_strength_db(0.01), -46.0206, 1e-4);
  EXPECT_NEAR(sonar::rigid_sphere_target_strength_db(0.1), -26.0206, 1e-4);
  EXPECT_NEAR(sonar::rigid_sphere_target_strength_db(1.0), -6.0206, 1e-4);
  EXPECT_EQ(sonar::rigid_sphere_target_strength_db(2.0), 0.0);
  EXPECT_NEAR(sonar::lambert_strength_db(sonar::kLambertMu_db, kPi / 2), -27.0, 1e-12);
  EXPECT_NEAR(sonar::lambert_strength_db(-27.0, radians(30)), -27.0 - 6.0206, 1e-4);
  EXPECT_NEAR(sonar::db_from_power(sonar::lambert_strength(-27.0, radians(10))),
              sonar::lambert_strength_db(-27.0, radians(10)), 1e-12);
  EXPECT_EQ(sonar::lambert_strength(-27.0, 0.0), 0.0);
  EXPECT_EQ(sonar::lambert_strength_db(-27.0, 0.0), -kInf);
  const double grazing = sonar::lambert_strength(-27.0, radians(0.01));
  EXPECT_GT(grazing, 0.0);
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

TEST(SonarReflection, ObliqueWavesFollowRayleigh) {
  const sonar::Medium water = sonar::kReferenceWater, sand = *sonar::material_of("sand");
  const auto at = [&](double grazing_rad) {
    return sonar::reflection_coefficient(water, sand, grazing_rad);
  };
  EXPECT_NEAR(std::abs(at(kPi / 2) - sonar::reflection_coefficient(water, sand)), 0.0, 1e-12);
  // Below the critical angle, acos(c1 / c2), everything comes back.
  const double critical = std::acos(water.sound_speed_m_s / sand.sound_speed_m_s);
  EXPECT_NEAR(std::abs(at(critical - 0.01)), 1.0, 1e-12);
  EXPECT_LT(std::abs(at(critical + 0.1)), 0.75);
  EXPECT_NEAR(std::abs(at(0.0) + 1.0), 0.0, 1e-12);
  // A denser, slower bottom (mud-like) is transparent at one angle, where Z2 sin g1 = Z1 sin g2.
  const sonar::Medium slow{1400.0, 1450.0};
  const double n = 1480.0 / 1450.0, m = 1400.0 / 997.0;
  const double intromission = std::atan(std::sqrt((n * n - 1) / (m * m - n * n)));
  EXPECT_NEAR(std::abs(sonar::reflection_coefficient(water, slow, intromission)), 0.0, 1e-9);
}

TEST(SonarTvg, LevelsPointTargetsExactly) {
  const sonar::Tvg point{40.0, true, {}};
  for (const double r : {0.05, 1.0, 10.0, 10000.0})
    EXPECT_NEAR(point.gain_db(r, 0.3) - sonar::two_way_loss_db(r, 0.3), 0.0, 1e-9) << r;
  EXPECT_NEAR((sonar::Tvg{30.0, false, {}}).gain_db(10.0, 0.3), 30.0, 1e-12);
  EXPECT_NEAR((sonar::Tvg{20.0, true, {}}).gain_db(10.0, 0.3), 26.0, 1e-12);
  EXPECT_EQ(sonar::Tvg{}.gain_db(10.0, 0.3), 0.0);
  EXPECT_TRUE(std::isfinite(point.gain_db(0.0, 0.3)));
  EXPECT_FALSE(sonar::validate(sonar::Tvg{-1.0, false, {}}).ok());
  EXPECT_FALSE(sonar::validate(sonar::Tvg{kNaN, false, {}}).ok());
}

TEST(SonarTvg, TablesAreReadAndFaultsToldByLine) {
  const test::ScratchFolder folder;
  const auto read = [&](const std::string& text) {
    EXPECT_TRUE(write_text(folder / "tvg.csv", text).ok());
    return sonar::read_tvg(folder / "tvg.csv");
  };
  const auto tvg = read("range_m,gain_db\n# near\n1, 0\n 10,20 # far\n");
  ASSERT_TRUE(tvg.ok()) << tvg.error().message;
  EXPECT_EQ(tvg->gain_db(0.5, 0.3), 0.0);
  EXPECT_NEAR(tvg->gain_db(5.5, 0.3), 10.0, 1e-12);
  EXPECT_EQ(tvg->gain_db(1e5, 0.3), 20.0);
  EXPECT_TRUE(sonar::validate(*tvg).ok());
  for (const auto& [text, told] :
       {std::pair{"1,0\n1,2\n", ":2: range_m is 1 after 1; accepted: rising values"},
        {"1,0\n2\n", ":2: found '2'; accepted: range_m,gain_db"},
        {"1,0\n2,x\n", ":2: found '2,x'; accepted: range_m,gain_db"},
        {"-1,0\n", ":1: range_m is -1; accepted: a number in [0, 1e+06]"},
        {"1,nan\n", ":1: gain_db is nan; accepted: a number in [-300, 300]"},
        {"range_m,gain_db\n", ": no row; accepted: rows of range_m,gain_db"}}) {
    const auto refused = read(text);
    ASSERT_FALSE(refused.ok()) << text;
    EXPECT_NE(refused.error().message.find(told), std::string::npos) << refused.error().message;
  }
}

}  // namespace
}  // namespace neritic
