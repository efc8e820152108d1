// The speed of missions and swims: over ground or through the water, in a current from each
// direction; as fast as it can, along its line without rising and sinking about it, and with thrust
// that is redistributed.
#include <cmath>
#include <map>

#include "testbed/simulation/mission_outlook.hpp"
#include "testbed/simulation/swim_outlook.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

std::string current_text(const Vec3& current_m_s) {
  return fmt::format("[physics]\n[current]\nkind = \"uniform\"\nvelocity_m_s = [{}, {}, {}]\n",
                     current_m_s.x, current_m_s.y, current_m_s.z);
}

// Means of one leg, from a while after its start until its waypoint is near.
struct LegMeans {
  double over_ground_m_s = 0.0, through_water_m_s = 0.0;  // along the leg
  double aside_m = 0.0;                                   // the most
  int count = 0;
};

// North, east, south, west, and down on the way back.
constexpr const char* kRound = R"(
waypoints = [
  { position_m = [0, -10, -8] },
  { position_m = [8, -10, -8] },
  { position_m = [8, -10, 0] },
  { position_m = [0, -12, 0] },
]
)";
const Vec3 kRound_m[] = {{0, -10, 0}, {0, -10, -8}, {8, -10, -8}, {8, -10, 0}, {0, -12, 0}};

std::array<LegMeans, 4> legs_of(const Vec3& current_m_s, const std::string& keys,
                                const std::string& vehicle_keys = "") {
  TestDive dive = dive_of(current_text(current_m_s) +
                          rov_text("position_m = [0, -10, 0]\n" + vehicle_keys +
                                   "[vehicles.mission]\nacceptance_m = 0.3\n" + keys + kRound));
  std::array<LegMeans, 4> legs;
  std::size_t leg = 0;
  double began_s = 0.0;
  const auto look = [&] {
    if (dive.vehicle().mission.left > leg) began_s = dive.time_s();
    leg = dive.vehicle().mission.left;
    if (leg >= 4 || dive.vehicle().mission.arrived > leg) return;
    const Vec3 way = glm::normalize(kRound_m[leg + 1] - kRound_m[leg]);
    const Vec3 flown = dive.pose().position_m - kRound_m[leg];
    const double left_m = glm::distance(kRound_m[leg + 1], kRound_m[leg]) - glm::dot(flown, way);
    if (dive.time_s() - began_s < 4.0 || left_m < 1.0) return;
    const rov::State& body = dive.vehicle().body;
    const Vec3 velocity = rov::world_from_ned(body.attitude * body.velocity.linear());
    LegMeans& means = legs[leg];
    ++means.count;
    means.over_ground_m_s += glm::dot(velocity, way);
    means.through_water_m_s += glm::dot(velocity - current_m_s, way);
    means.aside_m = std::max(means.aside_m, glm::length(flown - glm::dot(flown, way) * way));
  };
  while (dive.time_s() < 150.0 && dive.vehicle().mission.arrived < 4) dive.run(1.0, look);
  EXPECT_EQ(dive.vehicle().mission.arrived, 4u);
  for (LegMeans& means : legs) {
    EXPECT_GT(means.count, 240) << "of a second at least";
    means.over_ground_m_s /= means.count;
    means.through_water_m_s /= means.count;
  }
  return legs;
}

// The lines of what cannot be held.
std::string told(const std::string& scene_text) {
  std::string out;
  for (const std::string& line : cannot_hold(*dive_of(scene_text).world)) out += line;
  return out;
}

const Vec3 kCurrents_m_s[] = {{0, 0, 0},    {0, 0, -0.25},   {0.25, 0, 0},
                              {0, 0, 0.25}, {-0.25, 0, 0.0}, {0.15, 0.05, -0.15}};

// 0.37 to 0.65 m/s of 0.5 before it was said which speed it is.
TEST(MissionSpeed, OverGroundIsHeldOnEachLegInACurrentFromAnyDirection) {
  // speed_over says what is meant without it.
  const auto over_ground = "speed_m_s = 0.5\nspeed_over = \"ground\"\n";
  for (const char* keys :
       {"speed_m_s = 0.5\n", over_ground, "speed_m_s = 0.3\nheading_deg = 30\n"}) {
    const double wanted_m_s = keys[14] == '5' ? 0.5 : 0.3;
    const std::span<const Vec3> currents = kCurrents_m_s;
    for (const Vec3& current : keys == over_ground ? currents.last(1) : currents)
      for (const LegMeans& leg : legs_of(current, keys)) {
        EXPECT_NEAR(leg.over_ground_m_s, wanted_m_s, 0.03 * wanted_m_s)
            << keys << current.x << " " << current.z;
        EXPECT_LT(leg.aside_m, 0.3) << keys << current.x << " " << current.z;
      }
  }
}

TEST(MissionSpeed, ThroughTheWaterIsHeldOnEachLegInACurrentFromAnyDirection) {
  for (const char* keys : {"speed_m_s = 0.5\nspeed_over = \"water\"\n",
                           "speed_m_s = 0.5\nspeed_over = \"water\"\nheading_deg = 30\n"})
    for (const Vec3& current : kCurrents_m_s)
      for (const LegMeans& leg : legs_of(current, keys)) {
        EXPECT_NEAR(leg.through_water_m_s, 0.5, 0.05 * 0.5)
            << keys << current.x << " " << current.z;
        EXPECT_LT(leg.aside_m, 0.3) << keys << current.x << " " << current.z;
      }
}

TEST(MissionSpeed, AVehicleThatMeasuresHoldsItsSpeedOverGroundToo) {
  TestDive dive = dive_of(current_text({0, 0, 0.25}) +
                          rov_text(std::string(R"(position_m = [0, -10, 0]
navigation = "measured"
[vehicles.mission]
speed_m_s = 0.4
waypoints = [ { position_m = [0, -10, -12] } ]
)"),
                                   "rov", "bluerov2_heavy_survey_dynamics.toml") +
                          "[[objects]]\nname = \"floor\"\nclass = \"seabed\"\nshape = \"plane\"\n"
                          "size_m = [80, 80]\nposition_m = [0, -14, 0]\n");
  dive.run(6.0);
  const double from_m = dive.pose().position_m.z, from_s = dive.time_s();
  dive.run(15.0);
  EXPECT_NEAR((from_m - dive.pose().position_m.z) / (dive.time_s() - from_s), 0.4, 0.02);
}

TEST(MissionSpeed, AnOrbitHoldsItsSpeedOverGroundInACurrent) {
  for (const double speed_m_s : {0.3, -0.3}) {
    TestDive dive = dive_of(
        current_text({0.1, 0, 0.1}) +
        rov_text(fmt::format("position_m = [4, -10, 0]\nmission = {{ orbit = {{ point_m = [0, -10, "
                             "0], radius_m = 4, speed_m_s = {} }} }}\n",
                             speed_m_s)));
    dive.run(10.0);
    double way_m = 0.0;
    Vec3 before = dive.pose().position_m;
    std::array<double, 8> eighths_m{};  // of a round: of each direction
    for (double& eighth_m : eighths_m)
      dive.run(2.0 * kPi * 4.0 / 0.3 / 8.0, [&] {
        const Vec3 now = dive.pose().position_m;
        eighth_m += glm::distance(now, before);
        way_m += glm::distance(now, before);
        before = now;
      });
    EXPECT_NEAR(way_m, 2.0 * kPi * 4.0, 0.03 * 2.0 * kPi * 4.0);
    for (const double eighth_m : eighths_m)
      EXPECT_NEAR(eighth_m, 2.0 * kPi * 4.0 / 8.0, 0.06 * 2.0 * kPi * 4.0 / 8.0);
  }
}

TEST(MissionSpeed, TheOutlookNamesTheLegOnWhichItIsNotHeld) {
  const auto lines = [](const std::string& keys) {
    return told(current_text({0, 0, 0.45}) +
                rov_text("position_m = [0, -10, 0]\n[vehicles.mission]\n" + keys +
                         "waypoints = [ { position_m = [0, -10, 9] }, { position_m = [0, -10, -9] "
                         "} ]\n"));
  };
  EXPECT_EQ(lines("speed_m_s = 0.3\n"), "");
  EXPECT_NE(lines("speed_m_s = 0.8\n")
                .find("rov: 0.8 m/s over ground to waypoint 2 is 1.25 m/s "
                      "through the water, whose drag is"),
            std::string::npos)
      << lines("speed_m_s = 0.8\n");
  EXPECT_EQ(lines("speed_m_s = 0.4\nspeed_over = \"water\"\n"),
            "rov: 0.4 m/s through the water makes no way to waypoint 2 against a current of 0.45 "
            "m/s");
  EXPECT_EQ(lines("speed_m_s = 0.6\nspeed_over = \"water\"\n"), "");
}

// A mission without a speed that stays unfinished in a current is told before, and none that is
// finished well: at 0.6 m/s.
TEST(MissionSpeed, TheOutlookNamesTheLegOnWhichACurrentLeavesNoWay) {
  const auto lines = [](const Vec3& current_m_s, const std::string& keys) {
    return told(current_text(current_m_s) + rov_text("position_m = [0, -10, 0]\n" + keys) +
                "[[objects]]\nname = \"post\"\nshape = \"sphere\"\nposition_m = [20, -10, 0]\n");
  };
  const std::string way =
      "[vehicles.mission]\nwaypoints = [ { position_m = [0, -10, -8] }, { "
      "position_m = [0, -10, 8] } ]\n";
  const Vec3 south_east(0.5, 0, 0.5);
  EXPECT_EQ(lines(0.6 / 0.7072 * south_east, way), "");
  EXPECT_EQ(lines(0.6 / 0.7072 * south_east, way + "heading_deg = 30\n"), "");
  EXPECT_EQ(lines({0, 0, 0.7}, way), "");  // along its way
  const std::string aslant = lines(south_east, way + "heading_deg = 30\n");
  EXPECT_TRUE(aslant.starts_with("rov: the current of 0.707 m/s drags it with ")) << aslant;
  EXPECT_NE(aslant.find(" N on its way to waypoint 1, its thrusters push with "), std::string::npos)
      << aslant;
  EXPECT_TRUE(aslant.ends_with("it leaves its line and may not arrive")) << aslant;
  const std::string aside = lines({0.75, 0, 0}, way);
  EXPECT_NE(aside.find("on its way to waypoint "), std::string::npos) << aside;
  // Looking at its aim turns its side to the current; facing it, it stays.
  EXPECT_NE(lines({0, 0, 0.75}, "mission = { hold = \"station\", look_at = \"post\" }\n")
                .find("at the heading there: it drifts away"),
            std::string::npos);
  EXPECT_EQ(lines({0.75, 0, 0}, "mission = { hold = \"station\", look_at = \"post\" }\n"), "");
  EXPECT_NE(lines({0, 0, 0.75}, "mission = { orbit = { object = \"post\", radius_m = 4 } }\n")
                .find(" N on its orbit, its thrusters"),
            std::string::npos);
  EXPECT_EQ(lines({0, 0, 0.3}, "mission = { orbit = { object = \"post\", radius_m = 4 } }\n"), "");
}

double swim_m_s(const std::string& swim, const Vec3& current_m_s, const Vec3& to_m) {
  TestDive dive = dive_of(
      current_text(current_m_s) +
      diver_text(fmt::format("position_m = [0, -10, 0]\npitch_deg = -90\nyaw_deg = {}\nswim = {{ "
                             "{}, waypoints_m = [[{}, {}, {}]] }}\n",
                             degrees(std::atan2(-to_m.x, -to_m.z)), swim, to_m.x, to_m.y, to_m.z)));
  dive.run(30.0);
  const auto along_m = [&] {
    return glm::dot(rov::world_from_ned(dive.state().humans()[0].human.root.position_ned_m),
                    glm::normalize(to_m - Vec3(0, -10, 0)));
  };
  const double from_m = along_m();
  dive.run(40.0);
  return (along_m() - from_m) / 40.0;
}

TEST(MissionSpeed, ADiverSwimsThroughTheWaterOrOverGround) {
  const Vec3 north(0, -10, -80);
  EXPECT_NEAR(swim_m_s("speed_m_s = 0.4", {0, 0, 0.15}, north), 0.25, 0.02);
  EXPECT_NEAR(swim_m_s("speed_m_s = 0.4, speed_over = \"water\"", {0, 0, 0.15}, north), 0.25, 0.02);
  for (const Vec3& current : {Vec3(0, 0, 0.15), Vec3(0, 0, -0.15), Vec3(0.15, 0, 0)})
    EXPECT_NEAR(swim_m_s("speed_m_s = 0.4, speed_over = \"ground\"", current, north), 0.4, 0.02)
        << current.x << " " << current.z;
}

TEST(MissionSpeed, TheOutlookNamesWhatADiverCannotSwim) {
  const auto lines = [](const std::string& swim) {
    return told(current_text({0, 0, 0.45}) +
                diver_text("position_m = [0, -10, 0]\npitch_deg = -90\nswim = { " + swim +
                           ", waypoints_m = [[0, -10, 20], [0, -10, -20]] }\n"));
  };
  EXPECT_EQ(lines("speed_m_s = 0.15, speed_over = \"ground\""), "");
  EXPECT_EQ(
      lines("speed_m_s = 0.5, speed_over = \"ground\""),
      "diver: 0.5 m/s over ground to waypoint 2 is 0.95 m/s through the water; accepted: up to "
      "0.65 m/s, which legs reach with fins of 0.4 x 0.2 m");
  EXPECT_EQ(lines("speed_m_s = 0.4"),
            "diver: 0.4 m/s through the water makes no way to waypoint 2 in a current of 0.45 m/s; "
            "accepted: more, up to the 0.65 m/s that legs reach with fins of 0.4 x 0.2 m");
}

// Fins reach more than bare feet, and both what a run of them shows.
TEST(MissionSpeed, TheOutlookNamesASpeedThatTheFeetDoNotReach) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "bare.toml", "name = \"bare\"\nfins = false\n").ok());
  const auto scene = [&](const std::string& human, double speed_m_s) {
    return kStillWater +
           diver_text(fmt::format("position_m = [0, -10, 0]\npitch_deg = -90\nswim = {{ "
                                  "speed_m_s = {}, waypoints_m = [[0, -10, -90]] }}\n",
                                  speed_m_s),
                      human);
  };
  const std::string bare = (scratch / "bare.toml").string();
  EXPECT_EQ(told(scene({}, 0.6)), "");
  EXPECT_EQ(
      told(scene({}, 1.0)),
      "diver: 1 m/s to waypoint 1 found; accepted: up to 0.65 m/s, which legs reach with fins "
      "of 0.4 x 0.2 m");
  const std::string line = told(scene(bare, 0.6));
  EXPECT_NE(line.find("diver: 0.6 m/s to waypoint 1 found; accepted: up to 0."), std::string::npos)
      << line;
  EXPECT_NE(line.find(" m/s, which legs reach with bare feet"), std::string::npos) << line;
  for (const std::string& human : {std::string(), bare}) {
    TestDive dive = dive_of(scene(human, 1.2));
    dive.run(20.0);
    const Vec3 from = dive.state().humans()[0].human.root.position_ned_m;
    dive.run(10.0);
    const double swum_m_s =
        glm::distance(dive.state().humans()[0].human.root.position_ned_m, from) / 10.0;
    EXPECT_NEAR(fastest_m_s(dive.world->humans()[0]), swum_m_s, 0.05);
  }
}

TEST(MissionSpeed, TheOutlookNamesAPlaceInTheAirAndATiltThatThrustersDoNotHold) {
  const std::string mission =
      "position_m = [0, -10, 0]\n[vehicles.mission]\nspeed_m_s = 0.3\nwaypoints = [ { position_m = "
      "[0, -10, -4] }, { position_m = [0, 2, -4] } ]\n";
  EXPECT_EQ(told(kStillWater + rov_text(mission)),
            "rov: waypoint 2 lies 2 m above the surface; accepted: at it or below it");
  std::string text =
      read_text(std::filesystem::path(vehicles_folder()) / "bluerov2_heavy_dynamics.toml").value();
  const std::string centre = "buoyancy_centre_m = [0, 0, -0.01]";
  ASSERT_NE(text.find(centre), std::string::npos);
  text.replace(text.find(centre), centre.size(), "buoyancy_centre_m = [0.5, 0, -0.02]");
  const std::string thrust = "t200_thrust.csv";
  text.replace(text.find(thrust), thrust.size(), vehicles_folder() + "/" + thrust);
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "heavy_stern.toml", text).ok());
  const std::string lines = told(std::string(kStillWater) +
                                 "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\ndynamics = \"" +
                                 (scratch / "heavy_stern.toml").string() +
                                 "\"\nposition_m = [0, -10, 0]\nmission = { waypoints = [ { "
                                 "position_m = [0, -10, -4] } ] }\n");
  EXPECT_NE(lines.find("rov: its weight pulls the stern down with "), std::string::npos) << lines;
  EXPECT_NE(lines.find("left alone it tilts by "), std::string::npos) << lines;
}

TEST(MissionSpeed, TheOutlookNamesAWayThatIsTooSteepToSwim) {
  const auto lines = [](const std::string& points) {
    return told(kStillWater +
                diver_text("position_m = [0, -3, 0]\npitch_deg = -90\nswim = { speed_m_s = 0.4, "
                           "waypoints_m = [" +
                           points + "] }\n"));
  };
  EXPECT_EQ(lines("[0, -8, -20], [0, -4, 0]"), "");
  EXPECT_EQ(lines("[0, -25, -20], [10, -25, -20]"),
            "diver: waypoint 1 lies 22 m deeper and 20 m on: at 9 m a minute that takes 147 s, so "
            "that the diver circles there");
  EXPECT_EQ(lines("[0, -6, -20], [0, -3, -20]"),
            "diver: waypoint 2 lies 3 m higher and 0 m on: at 7.2 m a minute that takes 25 s, so "
            "that the diver circles there");
}

// With a tank at the side, whose gas weighs 1.5 kg; the current carries along, away, or across.
TEST(MissionSpeed, ADiverWithAStageTankMeetsSteepPlacesWithoutAFastAscent) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "diver.toml",
                         "name = \"deep\"\n[[tanks]]\nvolume_l = 15\npressure_bar = 230\noxygen = "
                         "0.32\n[[tanks]]\nvolume_l = 7\noxygen = 0.8\n")
                  .ok());
  for (const Vec3& current : {Vec3(0.0), Vec3(0, 0, 0.25)}) {
    TestDive dive = dive_of(
        current_text(current) +
        diver_text("position_m = [0, -3, 0]\npitch_deg = -90\nswim = { speed_m_s = 0.4, "
                   "speed_over = \"ground\", waypoints_m = [[0, -25, -20], [10, -25, -20]] }\n",
                   (scratch / "diver.toml").string()));
    double fastest_m_s = 0.0;
    for (int s = 0; s < 260; ++s) {
      dive.run(1.0);
      const auto& root = dive.state().humans()[0].human.root;
      fastest_m_s = std::max(fastest_m_s, -(root.attitude * root.velocity.linear()).z);
    }
    EXPECT_EQ(dive.state().humans()[0].arrived, 2u) << current.z;
    EXPECT_LT(60.0 * fastest_m_s, 15.0) << current.z;  // 25 where the tank hung beside the waist
  }
}

// Up to 0.7 m/s the thrusters master the water from the side; the controller's own integral stopped
// at 13.5 N, that of some 0.2 m/s, and every such mission stalled beside its first waypoint.
TEST(MissionSpeed, WaypointsAreReachedInAnyCurrentThatTheThrustersMaster) {
  for (const Vec3& current :
       {Vec3(0.3, 0, 0.1), Vec3(0.5, 0, 0), Vec3(0.35, 0, 0.35), Vec3(0, 0, -0.5), Vec3(0, 0.3, 0)})
    for (const std::string keys : {"speed_m_s = 0.3\n", ""}) {
      TestDive dive = dive_of(current_text(current) +
                              rov_text("position_m = [0, -10, 0]\n[vehicles.mission]\n" + keys +
                                       "waypoints = [ { position_m = [0, -10, -4] }, { position_m "
                                       "= [4, -10, -4], hold_s = 5 } ]\n"));
      dive.run(60.0);
      EXPECT_EQ(dive.vehicle().mission.arrived, 2u)
          << keys << current.x << " " << current.y << " " << current.z;
      EXPECT_LT(glm::distance(dive.pose().position_m, Vec3(4, -10, -4)), 0.12)
          << keys << current.x << " " << current.y << " " << current.z;
    }
}

TEST(MissionSpeed, AWrongKeyIsRefusedInOneLine) {
  const auto refused = [](const std::string& mission) {
    const auto scene = load_text("[physics]\n" + rov_text("mission = { " + mission + " }\n"));
    return scene.ok() ? std::string() : scene.error().message;
  };
  EXPECT_NE(
      refused("waypoints = [{ position_m = [0, -9, 0] }], speed_m_s = 1, speed_over = \"air\"")
          .find("speed_over: found \"air\"; accepted: one of ground, water"),
      std::string::npos);
  EXPECT_NE(refused("waypoints = [{ position_m = [0, -9, 0] }], speed_over = \"water\"")
                .find("no such key without speed_m_s"),
            std::string::npos);
  EXPECT_NE(
      refused("hold = \"station\", speed_over = \"water\"").find("no such key without waypoints"),
      std::string::npos);
}

// The root mean square of the vertical speed, less the one along the line, on level and sloping
// lines.
double heave_m_s(const std::string& dynamics, const std::string& mission_keys, double seconds) {
  TestDive dive = dive_of("[physics]\n" +
                          rov_text("position_m = [0, -20, 0]\n[vehicles.mission]\n" + mission_keys +
                                       "waypoints = [ { position_m = [0, -20, -25] }, { position_m "
                                       "= [20, -12, -25] }, { position_m = [20, -12, 0] } ]\n",
                                   "rov", dynamics));
  const Vec3 points[] = {{0, -20, 0}, {0, -20, -25}, {20, -12, -25}, {20, -12, 0}};
  double sum = 0.0;
  int count = 0;
  const auto look = [&] {
    const MissionState& mission = dive.vehicle().mission;
    if (mission.arrived > 2) return;
    const Vec3 way = glm::normalize(points[mission.left + 1] - points[mission.left]);
    const Vec3 off = dive.pose().position_m - points[mission.left];
    if (glm::dot(off, way) < 3.0) return;  // turns into the leg
    const rov::State& body = dive.vehicle().body;
    const Vec3 velocity = rov::world_from_ned(body.attitude * body.velocity.linear());
    const double across = (velocity - glm::dot(velocity, way) * way).y;
    sum += across * across;
    ++count;
  };
  while (dive.time_s() < seconds && dive.vehicle().mission.arrived < 3) dive.run(1.0, look);
  EXPECT_EQ(dive.vehicle().mission.arrived, 3u) << dynamics << " " << mission_keys;
  return std::sqrt(sum / std::max(count, 1));
}

// 0.37 m/s at 0.43 Hz before the pull to a far waypoint kept its direction, and depth came before
// way.
TEST(MissionSpeed, AsFastAsItCanItDoesNotRiseAndSinkAboutItsLine) {
  const std::string plain = "bluerov2_heavy_dynamics.toml";
  for (const std::string& dynamics : {plain, std::string("bluerov2_heavy_manual_dynamics.toml"),
                                      std::string("bluerov2_heavy_survey_dynamics.toml")})
    for (const char* keys : {"", "speed_m_s = 5\n", "heading_deg = 45\n", "speed_m_s = 0.6\n"}) {
      if (dynamics != plain && *keys != 0 && !test::is_thorough()) continue;
      EXPECT_LT(heave_m_s(dynamics, keys, 160.0), 0.035) << dynamics << " " << keys;
    }
}

// A BlueROV2 Heavy whose thrusters share so what they cannot give.
std::string saturating(const test::ScratchFolder& scratch, const std::string& policy) {
  const std::string name = policy + ".toml";
  EXPECT_TRUE(write_text(scratch / name, "include = \"" + vehicles_folder() +
                                             "/bluerov2_heavy_dynamics.toml\"\n[control]\n"
                                             "saturation = \"" +
                                             policy + "\"\n")
                  .ok());
  return "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\nsize_m = [0.57, 0.26, 0.46]\n"
         "dynamics = \"" +
         (scratch / name).string() + "\"\n";
}

// Mission after mission the same before, since the wrench was cut before it was allocated.
TEST(MissionSaturation, RedistributedThrustReachesAWaypointSoonerAndHoldsMoreCurrent) {
  const test::ScratchFolder scratch;
  std::map<std::string, double> fastest_m_s, ahead_m, off_m;
  for (const std::string policy : {"scale", "redistribute"}) {
    const std::string vehicle = saturating(scratch, policy);
    TestDive fast = dive_of("[physics]\n" + vehicle + R"(position_m = [0, -10, 0]
mission = { waypoints = [ { position_m = [0, -10, -40] } ] }
)");
    fast.run(15.0, [&] {
      fastest_m_s[policy] = std::max(fastest_m_s[policy], fast.speed_m_s());
      EXPECT_NEAR(fast.pose().position_m.y, -10.0, 0.1) << policy;
    });
    ahead_m[policy] = -fast.pose().position_m.z;
    // A speed over ground that the one reaches and the other does not.
    TestDive tracks = dive_of(current_text({0, 0, 0.45}) + vehicle + R"(position_m = [0, -10, 0]
mission = { speed_m_s = 0.42, waypoints = [ { position_m = [0, -10, -12] } ] }
)");
    tracks.run(20.0);
    off_m[policy] = std::abs(-tracks.pose().position_m.z - 0.42 * 20.0);
  }
  EXPECT_GT(fastest_m_s["redistribute"], 1.03 * fastest_m_s["scale"]);
  EXPECT_GT(ahead_m["redistribute"], ahead_m["scale"] + 0.3);
  EXPECT_LT(off_m["redistribute"], 0.8 * off_m["scale"]);
}

TEST(MissionSaturation, APilotsPushIsRedistributedToo) {
  const test::ScratchFolder scratch;
  std::map<std::string, double> speed_m_s;
  for (const std::string policy : {"scale", "redistribute"}) {
    TestDive dive = dive_of("[physics]\n" + saturating(scratch, policy) +
                            "position_m = [0, -10, 0]\nmission = { hold = \"station\" }\n");
    Piloting inputs;
    inputs.piloted = 1;
    inputs.pilot[0] = 200.0;
    pilot(dive, 0, inputs);
    dive.run(6.0);
    speed_m_s[policy] = dive.speed_m_s();
    EXPECT_NEAR(dive.pose().position_m.y, -10.0, 0.1) << policy;
  }
  EXPECT_GT(speed_m_s["redistribute"], 1.03 * speed_m_s["scale"]);
}

}  // namespace
}  // namespace neritic::testbed
