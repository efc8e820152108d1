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

// Fresh water over salt weighs less than salt alone: 18 m down by 28 kg/m^3 times 6 m, which is
// 0.17 m.
TEST(WaterLayers, PressOnAVehiclesSensorAndOnADiverByTheWeightOfAllAbove) {
  TestDive dive = dive_of(std::string(kStillWater) + kHalocline +
                          rov_text("position_m = [0, -18, 0]\nnavigation = \"truth\"\n", "rov",
                                   "bluerov2_heavy_survey_dynamics.toml") +
                          diver_text(std::string(kProne) + "position_m = [5, -18, 0]\n"));
  dive.run(0.1);
  const WaterColumn column = *dive.scene.water->column;
  double above_kg_m2 = 0.0;  // 18 m down, in slices of a centimetre
  for (int i = 0; i < 1800; ++i) above_kg_m2 += 0.01 * column.density_kg_m3(0.01 * (i + 0.5));
  EXPECT_GT(18.0 * column.density_kg_m3(18.0) - above_kg_m2, 160.0);
  const rov::SensorReadings& readings = *dive.world->readings(dive.state(), 0);
  ASSERT_GT(readings.pressure.count, 0u);
  EXPECT_NEAR(readings.pressure.value.pressure_pa, 101325.0 + 9.82 * above_kg_m2, 700.0);
  EXPECT_LT(readings.pressure.value.pressure_pa,
            101325.0 + 9.82 * 18.0 * column.density_kg_m3(18.0) - 900.0);
  const PhysicsHuman& diver = dive.world->humans()[0];
  EXPECT_NEAR(diver::pressure_at(diver.body, 18.0),
              diver.body.surface_pa + diver::kGravity_m_s2 * above_kg_m2, 5.0);
}

// A set that is not told of warm water fixes the vehicle too near, as a real one would.
TEST(WaterLayers, SoundCarriesUsblRangesAtItsOwnSpeed) {
  TestDive dive = dive_of(std::string(kStillWater) + kHalocline +
                          rov_text("position_m = [0, -18, -60]\nnavigation = \"truth\"\n", "rov",
                                   "bluerov2_heavy_survey_dynamics.toml"));
  dive.run(3.0);
  const rov::UsblReading& reading = dive.world->readings(dive.state(), 0)->usbl.value;
  ASSERT_EQ(reading.heard, 1u);
  const rov::Usbl& usbl = *dive.world->vehicles()[0].file.sensors.usbl;
  const Vec3 at = dive.vehicle().body.position_ned_m + dive.vehicle().body.attitude * usbl.beacon_m;
  const double distance_m = glm::distance(at, usbl.transceiver_ned_m);
  EXPECT_NEAR(2.0 * distance_m / reading.travel_s, 1485.0, 8.0);  // 1482.4 fresh, 1490 salt
  EXPECT_GT(std::abs(1500.0 * 0.5 * reading.travel_s - distance_m), 0.3);
}

}  // namespace
}  // namespace neritic::testbed
