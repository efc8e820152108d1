// Missions flown: waypoints reached in order, faced as said; circles, formations and stations held;
// with a thruster lost, on a tether, in a current, by a pilot.
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kStill = "title = \"still water\"\n[physics]\n";

TEST(Mission, WaypointsAreReachedInOrderAndTheLastIsHeld) {
  TestDive dive = dive_of(kStill + rov_text(R"(
position_m = [0, -10, 0]
[vehicles.mission]
speed_m_s = 0.4
waypoints = [
  { position_m = [0, -10, -4] },
  { position_m = [3, -8, -4], heading_deg = 200 },
  { position_m = [3, -8, 0], hold_s = 3 },
]
)"));
  const Vec3 wanted[] = {{0, -10, -4}, {3, -8, -4}, {3, -8, 0}};
  std::uint64_t arrived = 0;
  dive.run(60.0, [&] {
    const MissionState& mission = dive.vehicle().mission;
    ASSERT_LE(mission.arrived, arrived + 1);
    if (mission.arrived == arrived) return;
    // One control period after it came within the radius.
    EXPECT_LT(glm::distance(dive.pose().position_m, wanted[arrived]), 0.16) << arrived;
    ++arrived;
  });
  EXPECT_EQ(arrived, 3u);
  EXPECT_LT(glm::distance(dive.pose().position_m, wanted[2]), 0.01);
  EXPECT_LT(dive.speed_m_s(), 0.005);
  EXPECT_TRUE(dive.world->vehicles()[0].mission->done(dive.vehicle().mission));
}

// Without a speed it goes as fast as it can: level, since moments come before the push.
TEST(Mission, WithoutASpeedItFliesLevelAtFullThrust) {
  TestDive dive = dive_of(kStill + rov_text(R"(
position_m = [0, -20, 0]
mission = { waypoints = [ { position_m = [0, -20, -30] }, { position_m = [20, -10, -30] } ] }
)"));
  double most_tilt_rad = 0.0, fastest_m_s = 0.0, largest_n = 0.0;
  dive.run(75.0, [&] {
    const Vec3 up = dive.pose().rotation * Vec3(0.0, 1.0, 0.0);
    most_tilt_rad = std::max(most_tilt_rad, std::acos(std::min(1.0, up.y)));
    fastest_m_s = std::max(fastest_m_s, dive.speed_m_s());
    for (const double n : dive.vehicle().command_n) largest_n = std::max(largest_n, std::abs(n));
  });
  EXPECT_EQ(dive.vehicle().mission.arrived, 2u);
  EXPECT_LT(degrees(most_tilt_rad), 10.0);  // 56 and 62 without either
  EXPECT_GT(fastest_m_s, 0.8);
  EXPECT_GT(largest_n, 39.0);
}

TEST(Mission, AStopIsHeldForItsTime) {
  TestDive dive = dive_of(kStill + rov_text(R"(
position_m = [0, -10, 0]
[vehicles.mission]
waypoints = [ { position_m = [0, -10, -1], hold_s = 7 }, { position_m = [0, -10, -2] } ]
)"));
  double arrived_s = 0.0, left_s = 0.0;
  dive.run(30.0, [&] {
    const MissionState& mission = dive.vehicle().mission;
    if (mission.arrived == 1 && arrived_s == 0.0) arrived_s = dive.time_s();
    if (mission.left == 1 && left_s == 0.0) left_s = dive.time_s();
    if (arrived_s > 0.0 && left_s == 0.0) {
      EXPECT_LT(glm::distance(dive.pose().position_m, Vec3(0, -10, -1)), 0.16);
    }
  });
  EXPECT_NEAR(left_s - arrived_s, 7.0, 0.025);
}

TEST(Mission, ACourseThatRepeatsComesRoundAgain) {
  TestDive dive = dive_of(kStill + rov_text(R"(
position_m = [0, -10, 0]
[vehicles.mission]
repeat = true
waypoints = [ { position_m = [0, -10, -1] }, { position_m = [0, -10, 0] } ]
)"));
  dive.run(60.0);
  EXPECT_GE(dive.vehicle().mission.arrived, 8u);
  EXPECT_FALSE(dive.world->vehicles()[0].mission->done(dive.vehicle().mission));
}

// Degrees between two headings.
double apart_deg(double a, double b) {
  return std::abs(std::remainder(a - b, 360.0));
}

TEST(Mission, ItFacesWhereItIsTold) {
  TestDive dive = dive_of(kStill + std::string(R"(
[[objects]]
name = "buoy"
shape = "sphere"
position_m = [10, -6, 0]
)") + rov_text(R"(
position_m = [0, -10, 0]
[vehicles.mission]
waypoints = [
  { position_m = [0, -10, -3], hold_s = 6 },
  { position_m = [0, -10, 0], heading_deg = 225, hold_s = 6 },
  { position_m = [0, -10, 0.5], look_at = "buoy", hold_s = 6 },
  { position_m = [0, -10, 0], look_at = "buoy", tilt = true },
]
)"));
  const auto until_left = [&](std::uint64_t count) {
    while (dive.vehicle().mission.left < count && dive.time_s() < 100.0) dive.run(1.0 / 240.0);
  };
  until_left(1);
  EXPECT_LT(apart_deg(heading_deg(dive.pose()), 0.0), 1.0);  // along its way, north
  until_left(2);
  EXPECT_LT(apart_deg(heading_deg(dive.pose()), 225.0), 2.0);
  until_left(3);
  EXPECT_LT(apart_deg(heading_deg(dive.pose()), degrees(std::atan2(10.0, 0.5))), 1.0);
  EXPECT_LT(std::abs((dive.pose().rotation * Vec3(0, 0, -1)).y), 0.02);
  dive.run(25.0);
  const Vec3 ahead = dive.pose().rotation * Vec3(0, 0, -1);
  EXPECT_GT(glm::dot(ahead, glm::normalize(Vec3(10, 4, 0))), std::cos(radians(1.5)));
}

TEST(Mission, AnOrbitKeepsItsRadiusAndFacesItsCentre) {
  TestDive dive = dive_of(kStill + std::string(R"(
[[objects]]
name = "pillar"
shape = "cylinder"
position_m = [2, -12, 3]
)") + rov_text(R"(
position_m = [5, -9, 3]
mission = { orbit = { object = "pillar", radius_m = 4, speed_m_s = 0.3 }, look_at = "pillar" }
)"));
  dive.run(30.0);
  double turned_rad = 0.0;
  const auto bearing = [&] {
    const Vec3 off = dive.pose().position_m - Vec3(2, -12, 3);
    return std::atan2(off.x, -off.z);  // from north towards east
  };
  double before = bearing();
  dive.run(60.0, [&] {
    const Vec3 off = dive.pose().position_m - Vec3(2, -12, 3);
    EXPECT_NEAR(std::hypot(off.x, off.z), 4.0, 0.1);
    EXPECT_NEAR(off.y, 0.0, 0.05);
    EXPECT_GT(glm::dot(dive.pose().rotation * Vec3(0, 0, -1), -off / glm::length(off)), 0.99);
    turned_rad += std::remainder(bearing() - before, 2.0 * kPi);
    before = bearing();
  });
  EXPECT_NEAR(turned_rad, 60.0 * 0.3 / 4.0, 0.1 * 60.0 * 0.3 / 4.0);
}

TEST(Mission, ItFollowsWhatMovesOnATrackAndWhatMovesByPhysics) {
  TestDive dive = dive_of(kStill + std::string(R"(
[[objects]]
name = "sub"
shape = "sphere"
track = { waypoints_m = [[0, -10, 0], [30, -10, 0]], speed_m_s = 0.3 }
)") +
                          rov_text(R"(
position_m = [-2, -10, 2]
mission = { follow = { object = "sub", offset_m = [2, 1, 3] } }
)",
                                   "first") +
                          rov_text(R"(
position_m = [-4, -12, 2]
mission = { follow = { object = "first", offset_m = [0, 0, 2] } }
)",
                                   "second"));
  ASSERT_EQ(dive.world->vehicles().size(), 2u);
  dive.run(40.0);
  // The sub heads east: starboard is south (+z), up +y, back west (-x).
  for (int i = 0; i < 20; ++i) {
    dive.run(1.0);
    const Vec3 sub(0.3 * dive.time_s(), -10, 0);
    EXPECT_LT(glm::distance(dive.pose(0).position_m, sub + Vec3(-3, 1, 2)), 0.15);
    EXPECT_LT(glm::distance(dive.pose(1).position_m, dive.pose(0) * Vec3(0, 0, 2)), 0.15);
  }
}

TEST(Mission, ItStandsBetweenTwoAndFacesTheSecond) {
  TestDive dive = dive_of(kStill + std::string(R"(
[[objects]]
name = "diver"
shape = "sphere"
position_m = [0, -10, 0]
[[objects]]
name = "shark"
shape = "sphere"
track = { waypoints_m = [[8, -10, -6], [8, -10, 6]], speed_m_s = 0.2 }
)") + rov_text(R"(
position_m = [1, -10, 0]
mission = { stand_between = { a = "shark", b = "diver", distance_m = 2 } }
)"));
  dive.run(20.0);
  dive.run(30.0, [&] {
    const Vec3 shark(8, -10, -6 + 0.2 * dive.time_s()), diver(0, -10, 0);
    const Vec3 place = diver + 2.0 * glm::normalize(shark - diver);
    EXPECT_LT(glm::distance(dive.pose().position_m, place), 0.15);
    EXPECT_GT(glm::dot(dive.pose().rotation * Vec3(0, 0, -1),
                       glm::normalize(diver - dive.pose().position_m)),
              0.99);
  });
}

TEST(Mission, AStationIsHeldInACurrentAndWithAThrusterLost) {
  for (const char* failed : {"", "failed_thrusters = [2]\n", "failed_thrusters = [1, 7]\n"}) {
    TestDive dive = dive_of(std::string(R"([physics]
[current]
kind = "uniform"
velocity_m_s = [0.25, 0, 0.1]
)") + rov_text(std::string("position_m = [3, -7, 2]\nyaw_deg = 40\n") + failed +
               "mission = { hold = \"station\" }\n"));
    dive.run(60.0);
    EXPECT_LT(glm::distance(dive.pose().position_m, Vec3(3, -7, 2)), 0.02) << failed;
    EXPECT_LT(apart_deg(heading_deg(dive.pose()), 320.0), 1.0) << failed;
    for (std::size_t i = 0; i < 8; ++i) {
      if (dive.world->vehicles()[0].failed_thrusters >> i & 1) {
        EXPECT_EQ(dive.vehicle().command_n[i], 0.0) << failed;
      }
    }
  }
}

TEST(Mission, APilotTakesOverAndGivesBack) {
  TestDive dive = dive_of(kStill + rov_text("position_m = [0, -10, 0]\nyaw_deg = -90\n"
                                            "mission = { hold = \"station\" }\n"));
  dive.run(2.0);
  Piloting inputs;
  inputs.piloted = 1;
  inputs.pilot[0] = 40.0;  // forwards, which is east
  pilot(dive, 0, inputs);
  dive.run(5.0);
  const Vec3 flown = dive.pose().position_m;
  EXPECT_GT(flown.x, 1.5);
  EXPECT_NEAR(flown.y, -10.0, 0.05);  // depth and heading held
  EXPECT_NEAR(flown.z, 0.0, 0.05);
  EXPECT_LT(apart_deg(heading_deg(dive.pose()), 90.0), 2.0);
  inputs.pilot = {};
  inputs.pilot[5] = 3.0;  // to starboard
  pilot(dive, 0, inputs);
  dive.run(2.0);
  const double turned_deg = heading_deg(dive.pose());
  EXPECT_GT(apart_deg(turned_deg, 90.0), 30.0);
  pilot(dive, 0, Piloting{});
  dive.run(20.0);
  EXPECT_LT(dive.speed_m_s(), 0.005);  // station where it was given back
  EXPECT_GT(dive.pose().position_m.x, 1.5);
}

TEST(Mission, ATetherHoldsItBack) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "tethered.toml", "include = \"" + vehicles_folder() +
                                                        "/bluerov2_heavy_dynamics.toml\"\n"
                                                        "[tether]\nlength_m = 6\n")
                  .ok());
  ASSERT_TRUE(write_text(scratch / "dive.toml", std::string(R"([physics]
[[vehicles]]
name = "rov"
shape = "box"
size_m = [0.5, 0.3, 0.5]
dynamics = "tethered.toml"
position_m = [0, -10, 0]
tether_anchor_m = [0, -10, 2]
mission = { waypoints = [ { position_m = [0, -10, -20] } ] }
)"))
                  .ok());
  auto scene = scene::load_scene(scratch / "dive.toml");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  TestDive dive = dive_of(std::move(scene).value());
  dive.run(60.0);
  EXPECT_NEAR(dive.pose().position_m.z, -4.0, 0.3);
  EXPECT_EQ(dive.vehicle().mission.arrived, 0u);
}

}  // namespace
}  // namespace neritic::testbed
