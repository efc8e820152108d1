// Integrals over layered water against sums of thin slices, and closed forms of water that is alike
// everywhere.
#include "engine/core/layered_water.hpp"

#include <gtest/gtest.h>

namespace neritic {
namespace {

// Warm and brackish over cold and salty; then two transitions, the second colder.
WaterColumn halocline() {
  WaterColumn column{.temperature_c = 24.0, .salinity_psu = 2.0};
  column.layer[column.count++] = {
      .depth_m = 8.0, .thickness_m = 0.3, .temperature_c = 18.0, .salinity_psu = 35.0};
  column.layer[column.count++] = {
      .depth_m = 30.0, .thickness_m = 6.0, .temperature_c = 9.0, .salinity_psu = 35.5};
  return column;
}

// The midpoint rule with slices of 1 mm.
template <class Function>
double sum_of_slices(double from_m, double to_m, const Function& function) {
  const int slices = static_cast<int>(std::ceil((to_m - from_m) / 1e-3));
  const double thick_m = (to_m - from_m) / slices;
  double sum = 0.0;
  for (int i = 0; i < slices; ++i) sum += thick_m * function(from_m + (i + 0.5) * thick_m);
  return sum;
}

TEST(LayeredWater, ItsWeightIsThatOfAllLayersAbove) {
  const WaterColumn column = halocline();
  const LayeredWater water(column);
  for (const double depth_m : {0.5, 7.9, 8.0, 8.4, 20.0, 31.0, 60.0, 300.0}) {
    const double slices_kg_m2 =
        sum_of_slices(0.0, depth_m, [&](double z) { return column.density_kg_m3(z); });
    EXPECT_NEAR(water.mass_above_kg_m2(depth_m), slices_kg_m2, 1e-6 * slices_kg_m2) << depth_m;
    // The density there times the depth is not it.
    if (depth_m > 9.0) {
      EXPECT_GT(column.density_kg_m3(depth_m) * depth_m - slices_kg_m2, 150.0) << depth_m;
    }
  }
  EXPECT_EQ(water.mass_above_kg_m2(0.0), 0.0);
  EXPECT_EQ(water.mass_above_kg_m2(-3.0), 0.0);
  const LayeredWater alike(WaterColumn{.temperature_c = 10.0, .salinity_psu = 35.0});
  EXPECT_NEAR(alike.mass_above_kg_m2(77.0), 77.0 * sea_density_kg_m3({10.0, 35.0}), 1e-8);
}

TEST(LayeredWater, SoundTravelsAsSlicesOfItsProfileSay) {
  const WaterColumn column = halocline();
  const LayeredWater water(column);
  for (const auto& [from_m, to_m] :
       {std::pair(0.0, 40.0), {2.0, 7.0}, {7.9, 8.1}, {35.0, 2000.0}}) {
    const double seconds =
        sum_of_slices(from_m, to_m, [&](double z) { return 1.0 / column.sound_speed_m_s(z); });
    EXPECT_NEAR(water.mean_slowness_s_m(from_m, to_m), seconds / (to_m - from_m), 1e-10);
    EXPECT_EQ(water.mean_slowness_s_m(to_m, from_m), water.mean_slowness_s_m(from_m, to_m));
  }
  EXPECT_NEAR(1.0 / water.mean_slowness_s_m(5.0, 5.0), column.sound_speed_m_s(5.0), 1e-9);
}

}  // namespace
}  // namespace neritic
