// The places of missions that a vehicle cannot reach, and a Doppler log without a bottom, told
// before a dive; places that it reaches are not told.
#include "testbed/simulation/mission_outlook.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kSurveyRov = "bluerov2_heavy_survey_dynamics.toml";
constexpr const char* kPlainRov = "bluerov2_heavy_dynamics.toml";

std::string places_told(const std::string& scene_text) {
  std::string out;
  for (const std::string& line : cannot_hold(*dive_of(scene_text).world)) out += line + "\n";
  return out;
}

std::string bed_text(double y_m) {
  return fmt::format(
      "[[objects]]\nname = \"sand\"\nclass = \"seabed\"\nshape = \"plane\"\nsize_m = [200, 200]\n"
      "position_m = [0, {}, 0]\n",
      y_m);
}

std::string mission_text(const std::string& points, const char* dynamics = kPlainRov,
                         const std::string& keys = "") {
  return "[physics]\n" + rov_text("position_m = [0, -10, 0]\n[vehicles.mission]\n" + keys +
                                      "waypoints = [" + points + "]\n",
                                  "rov", dynamics);
}

TEST(PlaceOutlook, NamesTheFirstWaypointBelowTheBed) {
  const std::string points =
      "{ position_m = [0, -10, -4] }, { position_m = [0, -16, -4] }, { position_m = [0, -17, 0] }";
  EXPECT_EQ(places_told(mission_text(points) + bed_text(-14)),
            "rov: waypoint 2 lies 2 m below the bed sand: it is not reached; move it into the "
            "water, or give sand collision = false\n");
  EXPECT_EQ(places_told(mission_text(points) + bed_text(-18)), "");
  EXPECT_EQ(places_told(mission_text(points) + bed_text(-14) + "collision = false\n"), "");
}

TEST(PlaceOutlook, NamesAWaypointUnderATerrain) {
  const std::string folder = (test::source_dir() / "assets/terrain/ridge.npy").string();
  const std::string terrain = "[[objects]]\nname = \"ridge\"\nclass = \"seabed\"\nterrain = \"" +
                              folder + "\"\ncell_m = 0.5\nheight_offset_m = -24\n";
  EXPECT_EQ(places_told(mission_text("{ position_m = [0, -12, -4] }") + terrain), "");
  const std::string lines = places_told(mission_text("{ position_m = [0, -90, -4] }") + terrain);
  EXPECT_NE(lines.find("rov: waypoint 1 lies "), std::string::npos) << lines;
  EXPECT_NE(lines.find(" m below the bed ridge: "), std::string::npos) << lines;
}

// Within its acceptance of a free place it is reached.
TEST(PlaceOutlook, NamesAWaypointInsideAnObstacleUnlessAFreePlaceIsNearEnough) {
  const std::string boulder =
      "[[objects]]\nname = \"boulder\"\nclass = \"rock\"\nshape = \"box\"\nsize_m = [4, 4, 4]\n"
      "position_m = [0, -10, -6]\n";
  const std::string at = "{ position_m = [0, -10, -5] }";
  const std::string lines = places_told(mission_text(at) + boulder);
  EXPECT_NE(lines.find("rov: waypoint 1 lies "), std::string::npos) << lines;
  EXPECT_NE(lines.find(" m in boulder: it is not reached"), std::string::npos) << lines;
  EXPECT_EQ(places_told(mission_text(at, kPlainRov, "acceptance_m = 3\n") + boulder), "");
  EXPECT_EQ(places_told(mission_text("{ position_m = [0, -10, -3] }") + boulder), "");
  EXPECT_EQ(places_told(mission_text("{ position_m = [0, -10, -9] }") + boulder), "")
      << "behind it";
}

TEST(PlaceOutlook, NamesADopplerLogThatNeverHearsABottom) {
  const std::string points = "{ position_m = [0, -10, -30] }, { position_m = [0, -40, -30] }";
  EXPECT_NE(places_told(mission_text(points, kSurveyRov))
                .find("rov: its DVL never hears a bottom: the scene has nothing solid, so that its "
                      "navigation drifts; add a bed (class = \"seabed\"), dive nearer to it"),
            std::string::npos)
      << places_told(mission_text(points, kSurveyRov));
  const std::string deep = places_told(mission_text(points, kSurveyRov) + bed_text(-120));
  EXPECT_NE(deep.find("what lies under its way is 80 m off at best, it hears from 0.05 to 50 m"),
            std::string::npos)
      << deep;
  // In its range at the end of the way alone; from the start on; without such a sensor.
  EXPECT_EQ(places_told(mission_text(points, kSurveyRov) + bed_text(-80)), "");
  EXPECT_EQ(places_told(mission_text(points, kSurveyRov) + bed_text(-50)), "");
  EXPECT_EQ(places_told(mission_text(points) + bed_text(-120)), "");
  EXPECT_NE(places_told("[physics]\n" +
                        rov_text("position_m = [0, -10, 0]\nmission = { hold = "
                                 "\"station\" }\n",
                                 "rov", kSurveyRov) +
                        bed_text(-120))
                .find("110 m off at best"),
            std::string::npos);
}

// A diver's plan is told as a vehicle's mission: he reaches a place within his acceptance of it.
TEST(PlaceOutlook, NamesADiversWaypointsInTheAirTheBedAndAnObstacle) {
  const auto told = [](const std::string& points, const std::string& more) {
    return places_told("[physics]\n" +
                       diver_text("position_m = [0, -10, 0]\npitch_deg = -90\nswim = { speed_m_s = "
                                  "0.2, waypoints_m = [" +
                                  points + "] }\n") +
                       more);
  };
  EXPECT_EQ(told("[0, -10, -20], [0, -9, -60], [0, 1.5, -160]", bed_text(-20)),
            "diver: waypoint 3 lies 1.5 m above the surface; accepted: at it or below it\n");
  EXPECT_EQ(told("[0, -10, -20], [0, -13, -60], [0, -18, -90]", bed_text(-14)),
            "diver: waypoint 3 lies 4 m below the bed sand: it is not reached; move it into the "
            "water, or give sand collision = false\n");
  const std::string boulder =
      "[[objects]]\nname = \"boulder\"\nclass = \"rock\"\nshape = \"box\"\nsize_m = [8, 8, 8]\n"
      "position_m = [0, -10, -30]\n";
  const std::string inside = told("[0, -10, -30]", boulder);
  EXPECT_NE(inside.find("diver: waypoint 1 lies "), std::string::npos) << inside;
  EXPECT_NE(inside.find(" m in boulder: it is not reached"), std::string::npos) << inside;
  EXPECT_EQ(told("[0, -10, -24.5]", boulder), "");
}

// The survey vehicle's sensor is set to sea water of 1028 kg/m^3.
TEST(PlaceOutlook, NamesAPressureSensorThatIsSetToOtherWater) {
  const auto told = [](const std::string& keys, const char* dynamics) {
    return places_told("[physics]\n" + keys +
                       rov_text("position_m = [0, -10, 0]\n[vehicles.mission]\nwaypoints = [{ "
                                "position_m = [0, -30, -4] }]\n",
                                "rov", dynamics) +
                       bed_text(-34));
  };
  EXPECT_EQ(told("water_kg_m3 = 1028\n", kSurveyRov).find("its depth reads"), std::string::npos);
  const std::string lake = told("water_kg_m3 = 999\n", kSurveyRov);
  EXPECT_NE(lake.find("rov: its depth reads 0.85 m too shallow at 30 m: pressure.water_kg_m3 = "
                      "1028, the scene's water is 999; it navigates by it\n"),
            std::string::npos)
      << lake;
  EXPECT_EQ(told("water_kg_m3 = 999\n", kPlainRov).find("its depth reads"), std::string::npos);
}

}  // namespace
}  // namespace neritic::testbed
