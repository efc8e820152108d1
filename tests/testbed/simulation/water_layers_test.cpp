// Bodies and divers' cold read the profile of the water's layers.
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

// Fresh over salt, 6 m down.
constexpr const char* kHalocline =
    "[water]\ntemperature_c = 20\nsalinity_psu = 0\n[[water.layers]]\ndepth_m = 6\nthickness_m = "
    "1\nsalinity_psu = 35\ntemperature_c = 10\n";

TEST(WaterLayers, AThingOfTheDensityBetweenComesToRestInTheHalocline) {
  // 1012 kg/m^3: sinks in fresh water (998.2), floats on the sea (1026.95).
  TestDive dive =
      dive_of(std::string(kStillWater) + kHalocline +
              "[[objects]]\nname = \"tool\"\nclass = \"target\"\nshape = \"sphere\"\nradius_m = "
              "0.05\nposition_m = [0, -1, 0]\nthing = { mass_kg = 1.012, volume_l = 1, "
              "drag_area_m2 = 0.05 }\n");
  dive.run(240.0);
  const double depth_m = -dive.state().objects()[0].motion.pose.position_m.y;
  // Where the layer's water weighs as much, found by halving.
  const WaterColumn column = *dive.scene.water->column;
  double high_m = 0.0, low_m = 12.0;
  for (int i = 0; i < 60; ++i) {
    const double middle_m = 0.5 * (high_m + low_m);
    (column.density_kg_m3(middle_m) < 1012.0 ? high_m : low_m) = middle_m;
  }
  EXPECT_NEAR(depth_m, high_m, 0.03);
  EXPECT_NEAR(depth_m, 6.0, 0.5);
}

TEST(WaterLayers, LiftAVehicleByTheDensityItIsIn) {
  const auto heave_m_s = [&](const std::string& water) {
    TestDive dive = dive_of(std::string(kStillWater) + water +
                            rov_text("position_m = [0, -10, 0]\nnavigation = \"truth\"\n"));
    dive.run(0.1);
    return dive.state().vehicles()[0].body.velocity.linear().z;
  };
  const auto salt = [](double psu) {
    return fmt::format(
        "[water]\ntemperature_c = 10\nsalinity_psu = 0\n[[water.layers]]\ndepth_m = "
        "6\nsalinity_psu "
        "= {}\n",
        psu);
  };
  // 0, 17.5 and 35 psu at 10 C: 999.70, 1013.28 and 1026.95 kg/m^3.
  const double none = heave_m_s(salt(0.0)), half = heave_m_s(salt(17.5)), all = heave_m_s(salt(35));
  EXPECT_LT(half, none);  // north, east, down: it rises
  EXPECT_NEAR((all - none) / (half - none), (1026.95 - 999.70) / (1013.28 - 999.70), 0.02);
}

TEST(WaterLayers, ChillADiverAsWaterOfThatTemperatureDoes) {
  const auto cold = [&](const std::string& water, const std::string& condition) {
    TestDive dive =
        dive_of(std::string(kStillWater) + water +
                diver_text(std::string(kProne) +
                           "position_m = [0, -20, 0]\ncondition = " + condition + "\n"));
    dive.run(2.0);
    return dive.state().conditions()[0].cold;
  };
  const std::string warm =
      "[water]\ntemperature_c = 24\n[[water.layers]]\ndepth_m = 8\ntemperature_c = 9\n";
  const double layers = cold(warm, "{}").skin_c;
  EXPECT_NEAR(layers, cold("", "{ water_c = 9 }").skin_c, 0.02);
  EXPECT_NEAR(cold(warm, "{ water_c = 20 }").skin_c, cold("", "{ water_c = 20 }").skin_c, 0.02);
  EXPECT_GT(cold(warm, "{ water_c = 20 }").skin_c, layers + 1.0);
}

}  // namespace
}  // namespace neritic::testbed
