// Temperature, salinity, density, sound speed and refractive index of water in layers.
#include "engine/core/water_column.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace neritic {
namespace {

WaterColumn cenote() {
  WaterColumn column{.temperature_c = 25.0, .salinity_psu = 1.0};
  column.layer[0] = {
      .depth_m = 12.0, .thickness_m = 0.5, .temperature_c = 26.0, .salinity_psu = 34.0};
  column.count = 1;
  return column;
}

TEST(SeaWater, HasThePublishedDensitySoundSpeedAndIndex) {
  // Check values of UNESCO 1983, technical paper 44, p. 19.
  EXPECT_NEAR(sea_density_kg_m3({5.0, 0.0}), 999.96675, 1e-5);
  EXPECT_NEAR(sea_density_kg_m3({5.0, 35.0}), 1027.67547, 1e-5);
  EXPECT_NEAR(sea_density_kg_m3({25.0, 35.0}), 1023.34306, 1e-5);
  // Mackenzie's own.
  EXPECT_NEAR(sea_sound_speed_m_s({25.0, 35.0}, 1000.0), 1550.744, 1e-3);
  // Pure water at 20 C and the D line (Tilton and Taylor 1938), and sea water (Austin and Halikas
  // 1976).
  EXPECT_NEAR(sea_refractive_index({20.0, 0.0}, 589.3), 1.33299, 1e-4);
  EXPECT_NEAR(sea_refractive_index({20.0, 35.0}, 589.3), 1.33940, 1e-4);
}

TEST(WaterColumn, GoesFromLayerToLayerWithinTheThickness) {
  const WaterColumn column = cenote();
  EXPECT_EQ(column.at(0.0).salinity_psu, 1.0);
  EXPECT_NEAR(column.at(12.0).salinity_psu, 17.5, 1e-12);
  EXPECT_NEAR(column.at(20.0).salinity_psu, 34.0, 1e-12);
  EXPECT_NEAR(column.at(12.0).temperature_c, 25.5, 1e-12);
  // The steepest gradient makes the whole step within the thickness.
  const double h = 1e-5;
  EXPECT_NEAR((column.at(12.0 + h).salinity_psu - column.at(12.0 - h).salinity_psu) / (2.0 * h),
              33.0 / 0.5, 1e-3);
  for (double depth_m = 0.0; depth_m < 30.0; depth_m += 0.05)
    EXPECT_GE(column.density_kg_m3(depth_m + 0.05), column.density_kg_m3(depth_m));
}

}  // namespace
}  // namespace neritic
