// Compressibility and consumption against published figures.
#include <gtest/gtest.h>

#include "diver/real_gas.hpp"

namespace neritic::diver {
namespace {

constexpr double kBar = 1e5;

// Z of cubic fits to Perry's tables at 300 K.
TEST(RealGas, CompressibilityIsThatOfTheTables) {
  const double bars[] = {50, 100, 150, 200, 232, 300};
  struct Row {
    GasMix mix;
    double z[6];
  };
  const Row rows[] = {{{0.21, 0.0}, {0.990818, 0.994696, 1.010168, 1.035766, 1.056785, 1.111473}},
                      {{0.50, 0.0}, {0.983526, 0.980078, 0.988312, 1.006888, 1.023584, 1.069694}},
                      {{1.00, 0.0}, {0.970954, 0.954873, 0.950631, 0.957099, 0.96634, 0.997661}},
                      {{0.18, 0.45}, {1.004196, 1.015387, 1.032812, 1.055709, 1.072883, 1.114875}}};
  for (const Row& row : rows)
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(compressibility(row.mix, bars[i] * kBar), row.z[i], 1e-4) << i;
  EXPECT_NEAR(compressibility(kAir, 200 * kBar), 1.0358, 5e-5);
}

// Perry, air at 300 K: an independent table of the mixture itself.
TEST(RealGas, AirIsThatOfItsOwnTableWithinHalfAPercent) {
  const double table[][2] = {{10, 0.9974},  {40, 0.9917},  {100, 0.9930},
                             {150, 1.0074}, {200, 1.0326}, {300, 1.1089}};
  for (const auto& [bar, z] : table)
    EXPECT_NEAR(compressibility(kAir, bar * kBar), z, 0.005) << bar;
}

TEST(RealGas, PressureAndMolesAreInverse) {
  for (const GasMix mix : {kAir, GasMix{0.32, 0.0}, GasMix{1.0, 0.0}, GasMix{0.10, 0.70}})
    for (const double bar : {0.0, 1e-6, 0.5, 1.0, 20.0, 150.0, 232.0, 300.0, 350.0, 500.0})
      EXPECT_NEAR(pressure_of(mix, 0.012, moles_in(mix, 0.012, bar * kBar)), bar * kBar,
                  1e-9 * bar * kBar + 1e-9)
          << bar;
}

TEST(RealGas, MoreGasIsMorePressureThroughout) {
  for (const GasMix mix : {kAir, GasMix{1.0, 0.0}, GasMix{0.0, 1.0}}) {
    double last = -1.0;
    for (double moles = 0.0; moles < 400.0; moles += 0.5) {
      const double pa = pressure_of(mix, 0.012, moles);
      EXPECT_GT(pa, last) << moles;
      last = pa;
    }
  }
}

TEST(RealGas, ATankOfAirWeighsAsItShould) {
  // 12 litres at 200 bar and 20 C.
  EXPECT_NEAR(moles_in(kAir, 0.012, 200 * kBar) * molar_mass(kAir), 2.7555, 0.02);
}

// 12 litres from 200 to 150 bar in 10 minutes at 20 m (1025 kg/m^3, 9.80665 m/s^2).
TEST(RealGas, ConsumptionIsIdealAndRealAsPublished) {
  const double ambient_pa = 101325.0 + 1025.0 * 9.80665 * 20.0;
  const double ideal = 12.0 * (200 - 150) * kBar / (10.0 * ambient_pa);
  EXPECT_NEAR(ideal, 19.84, 0.005);
  const double real = 1e3 *
                      (moles_in(kAir, 0.012, 200 * kBar) - moles_in(kAir, 0.012, 150 * kBar)) *
                      kGasConstant * kTankTemperature_k / (10.0 * ambient_pa);
  EXPECT_NEAR(real, 17.70, 0.01);
}

}  // namespace
}  // namespace neritic::diver
