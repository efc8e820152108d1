// Missions that make no way or end off their place are told after a run; those on their way are
// not.
#include "testbed/simulation/mission_progress.hpp"

#include "testbed/simulation/mission_outlook.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

std::string told_after(const std::string& scene_text, double seconds) {
  TestDive dive = dive_of(scene_text);
  MissionProgress progress(*dive.world);
  progress.add(dive.simulation->newest());
  dive.run(seconds, [&] { progress.add(dive.simulation->newest()); });
  std::string out;
  for (const std::string& line : unfinished(*dive.world, dive.state(), dive.time_s(), &progress))
    out += line + "\n";
  return out;
}

std::string water_text(const char* current) {
  return std::string("[physics]\n") +
         (*current ? fmt::format("[current]\nkind = \"uniform\"\nvelocity_m_s = {}\n", current)
                   : std::string());
}

std::string told_mission_text(const std::string& mission) {
  return rov_text("position_m = [0, -10, 0]\nmission = { " + mission + " }\n");
}

constexpr const char* kWallAhead =
    "[[objects]]\nname = \"wall\"\nclass = \"rock\"\nshape = \"box\"\nsize_m = [40, 40, 1]\n"
    "position_m = [0, -10, -4]\n";

// At 0.3 m/s the way takes 200 s: after 60 no more was asked than that it had begun.
TEST(MissionProgress, AVehicleStuckAtAWallMakesNoWay) {
  const std::string beyond = "speed_m_s = 0.3, waypoints = [ { position_m = [0, -10, -60] } ]";
  const std::string told =
      told_after(water_text("") + told_mission_text(beyond) + kWallAhead, 60.0);
  EXPECT_NE(told.find("rov: 1 of 1 waypoints left after 60 s, 56"), std::string::npos) << told;
  EXPECT_NE(told.find(" m to the next, no nearer to it for 4"), std::string::npos) << told;
  EXPECT_EQ(told_after(water_text("") + told_mission_text(beyond), 60.0), "");
  // A mission without an end too.
  const std::string round = told_after(
      water_text("") +
          told_mission_text("repeat = true, speed_m_s = 0.3, waypoints = [ { position_m = "
                            "[0, -10, -60] }, { position_m = [0, -10, 0] } ]") +
          kWallAhead,
      60.0);
  EXPECT_NE(round.find("rov: 56"), std::string::npos) << round;
  EXPECT_NE(round.find(" m to waypoint 1, no nearer to it for 4"), std::string::npos) << round;
}

TEST(MissionProgress, AVehicleThatWaitsAtAWaypointMakesItsWay) {
  EXPECT_EQ(
      told_after(water_text("") +
                     told_mission_text("speed_m_s = 0.3, waypoints = [ { position_m = [0, -10, "
                                       "-2], hold_s = 60 }, { position_m = [0, -10, -20] } ]"),
                 50.0),
      "");
}

// Whose way has no time that suffices.
TEST(MissionProgress, ADiverInACurrentThatIsFasterMakesNoWay) {
  const std::string diver =
      diver_text(std::string("position_m = [0, -10, 0]\n") + kProne +
                 "swim = { speed_m_s = 0.4, waypoints_m = [[0, -10, -30]] }\n");
  const std::string told = told_after(water_text("[0, 0, 0.8]") + diver, 40.0);
  EXPECT_NE(told.find("diver: 1 of 1 waypoints left after 40 s, 4"), std::string::npos) << told;
  EXPECT_NE(told.find(" m to the next, no nearer to it for "), std::string::npos) << told;
  EXPECT_EQ(told_after(water_text("") + diver, 40.0), "");
}

TEST(MissionProgress, AVehicleOffItsStationOrbitOrFollowedParticipantIsTold) {
  const std::string station = told_mission_text("hold = \"station\"");
  EXPECT_EQ(told_after(water_text("[0.3, 0, 0]") + station, 30.0), "");
  const std::string drifted = told_after(water_text("[2.5, 0, 0]") + station, 30.0);
  EXPECT_NE(drifted.find("rov: "), std::string::npos) << drifted;
  EXPECT_NE(drifted.find(" m off its station at the end; accepted: up to 2 m"), std::string::npos)
      << drifted;

  const std::string post =
      "[[objects]]\nname = \"post\"\nshape = \"box\"\nsize_m = [0.1, 0.1, 0.1]\n"
      "position_m = [0, -10, -6]\ncollision = false\n";
  const std::string orbit =
      told_mission_text("orbit = { object = \"post\", radius_m = 4, speed_m_s = 0.3 }");
  EXPECT_EQ(told_after(water_text("") + post + orbit, 40.0), "");
  const std::string carried = told_after(water_text("[2.5, 0, 0]") + post + orbit, 40.0);
  EXPECT_NE(carried.find(" m off the circle of its orbit at the end"), std::string::npos)
      << carried;

  const auto runner = [](double m_s) {
    return fmt::format(
        "[[objects]]\nname = \"runner\"\nshape = \"box\"\nsize_m = [0.1, 0.1, 0.1]\n"
        "collision = false\ntrack = {{ waypoints_m = [[0, -10, -2], [0, -10, -400]], speed_m_s = "
        "{} }}\n",
        m_s);
  };
  const std::string follow =
      told_mission_text("follow = { object = \"runner\", offset_m = [0, 0, 2] }");
  EXPECT_EQ(told_after(water_text("") + runner(0.3) + follow, 40.0), "");
  const std::string lost = told_after(water_text("") + runner(4.0) + follow, 40.0);
  EXPECT_NE(lost.find(" m off its place beside whom it follows at the end"), std::string::npos)
      << lost;
  // Not yet there, but on its way.
  EXPECT_EQ(
      told_after(water_text("") + runner(0.1) +
                     told_mission_text("follow = { object = \"runner\", offset_m = [0, 0, -30] }"),
                 8.0),
      "");
}

}  // namespace
}  // namespace neritic::testbed
