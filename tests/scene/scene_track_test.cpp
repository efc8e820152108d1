// Tracks of scene files: what moves carries what hangs on it, offsets move them, files give times
// and attitudes, and each wrong one ends in its line.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

constexpr const char* kConvoy = R"(
[[vehicles]]
name = "ship"
shape = "box"
[vehicles.track]
waypoints_m = [[0, 0, 0], [20, 0, 0]]
speed_m_s = 2
[[vehicles.cameras]]
position_m = [0, -1, -2]
[[vehicles.lamps]]
position_m = [1, 0, 0]
[[objects]]
name = "towed"
shape = "sphere"
on = "ship"
scale = 3
[objects.track]
waypoints_m = [[0, -5, 10], [0, -15, 10]]
speed_m_s = 1
heading = "fixed"
[[objects]]
name = "rock"
shape = "sphere"
position_m = [7, -9, 1]
[[sonars]]
on = "towed"
position_m = [0, 0, -1]
)";

// Another way to name a place or an attitude replaces the included one.
TEST(SceneTrack, AnIncludingTableNamesAPlaceInAnotherWay) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "base.toml", R"(
[[objects]]
name = "swimmer"
shape = "sphere"
pitch_deg = -80
track = { waypoints_m = [[0, -5, 0], [10, -5, 0], [10, -5, 10]], speed_m_s = 1, repeat = true }
[[objects]]
name = "stone"
shape = "sphere"
position_m = [1, -9, 1]
look_at = "swimmer"
)")
                  .ok());
  const Scene scene = scene_of(scratch, R"(include = "base.toml"
[[objects]]
name = "swimmer"
position_m = [3, -4, 5]
[[objects]]
name = "stone"
yaw_deg = 90
track = { waypoints_m = [[0, -9, 0], [0, -9, 8]], speed_m_s = 1, repeat = true, heading = "fixed" }
)");
  expect_near(scene.world_from(scene.objects[0].mount, 50.0).position_m, {3, -4, 5});
  expect_near(scene.world_from(scene.objects[1].mount, 20.0).position_m, {0, -9, 4});
  expect_near(scene.world_from(scene.objects[1].mount, 20.0).rotation * Vec3(0, 0, -1), {-1, 0, 0});
}

TEST(SceneTrack, WhatMovesCarriesWhatHangsOnIt) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, kConvoy);
  ASSERT_EQ(scene.objects.size(), 3u);
  // Eastwards: the ship's -z is +x, its +z is -x, its +x is +z.
  const Mount &towed = scene.objects[0].mount, &rock = scene.objects[1].mount,
              &ship = scene.objects[2].mount;
  const auto at = [&](const Mount& mount, double t) {
    return scene.world_from(mount, t).position_m;
  };
  expect_near(at(ship, 0), {0, 0, 0});
  expect_near(at(ship, 5), {10, 0, 0});
  expect_near(at(ship, 1000), {20, 0, 0});
  expect_near(at(scene.cameras[0].mount, 5), {12, -1, 0});
  expect_near(at(scene.lamps[0].mount, 5), {10, 0, 1});
  expect_near(at(towed, 0), {-10, -5, 0});
  expect_near(at(towed, 4), {-2, -9, 0});
  expect_near(at(scene.sonars[0].mount, 4), {-1, -9, 0});
  expect_near(at(rock, 4), {7, -9, 1});
  expect_near(scene.world_from(scene.sonars[0].mount, 4).rotation * Vec3(0, 0, -1), {1, 0, 0});
  expect_near(Vec3(scene.world_from_copy(scene.objects[0], 0, 4) * Vec4(0, 1, 0, 1)), {-2, -6, 0});
}

TEST(SceneTrack, AnOffsetMovesTracksOfTheWorldAndNoOthers) {
  const test::ScratchFolder scratch;
  const Vec3 offset(1e5, -3, 2e5);
  const Scene here = scene_of(scratch, kConvoy), there = scene_of(scratch, kConvoy, {offset});
  for (const double t : {-1.0, 0.0, 3.3, 50.0}) {
    for (std::size_t i = 0; i < here.objects.size(); ++i)
      expect_near(there.world_from(there.objects[i].mount, t).position_m,
                  here.world_from(here.objects[i].mount, t).position_m + offset);
    expect_near(there.world_from(there.cameras[0].mount, t).position_m,
                here.world_from(here.cameras[0].mount, t).position_m + offset);
  }
}

TEST(SceneTrack, ASensorMovesByItselfAndLooksWhereItIsTold) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, R"(
[[sonars]]
pitch_deg = -90
[sonars.track]
lawn_mower = { area_m = [0, 0, 10, 40], depth_m = 3, spacing_m = 5 }
speed_m_s = 1
start_s = 10
[[cameras]]
look_at = "ball"
[cameras.track]
waypoints_m = [[0, 0, 4], [0, 0, 8]]
speed_m_s = 1
start_s = -2
heading = "fixed"
[[objects]]
name = "ball"
shape = "sphere"
position_m = [-6, 0, 6]
)");
  const Mount &sonar = scene.sonars[0].mount, &camera = scene.cameras[0].mount;
  expect_near(scene.world_from(sonar, 0).position_m, {0, -3, 0});
  expect_near(scene.world_from(sonar, 60).position_m, {5, -3, 35});  // the second of three legs
  expect_near(scene.world_from(sonar, 60).rotation * Vec3(0, 0, -1), {0, -1, 0});
  expect_near(scene.world_from(sonar, 60).rotation * Vec3(0, 1, 0), {0, 0, -1});
  expect_near(scene.world_from(sonar, 1e6).position_m, {10, -3, 40});
  // Where it is at time 0, which two seconds after the start is [0, 0, 6]: straight west.
  expect_near(scene.world_from(camera, 0).position_m, {0, 0, 6});
  expect_near(camera.pose.position_m, {0, 0, 6});
  for (const double t : {-5.0, 0.0, 5.0})
    expect_near(scene.world_from(camera, t).rotation * Vec3(0, 0, -1), {-1, 0, 0});
}

TEST(SceneTrack, WhatOnlyCarriesNeedNotBeDrawn) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, R"(
[[objects]]
name = "carriage"
track = { waypoints_m = [[0, 0, 0], [0, 0, -9]], speed_m_s = 3 }
[[objects.sonars]]
position_m = [0, -1, 0]
)");
  EXPECT_TRUE(scene.models.empty());
  EXPECT_EQ(scene.objects.at(0).model, -1);
  expect_near(scene.world_from(scene.sonars.at(0).mount, 2).position_m, {0, -1, -6});
}

TEST(SceneTrack, AFileGivesTimesAndAttitudesOrWaypoints) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(
      write_text(scratch / "a.csv", "t,x,y,z,yaw,pitch,roll\n1,0,0,0,0,0,0\n3,4,0,0,90,0,0\n")
          .ok());
  ASSERT_TRUE(write_text(scratch / "b.csv", "# east\n-1,0,0,0\n1,2,0,0\n9,2,0,0\n10,2,0,9").ok());
  ASSERT_TRUE(write_text(scratch / "c.csv", "0,0,0\n0,-7,0").ok());
  const Scene scene = scene_of(scratch, R"(
[[cameras]]
track = { file = "a.csv" }
[[lamps]]
track = { file = "b.csv", turn_m = 0 }
[[sonars]]
track = { file = "c.csv", speed_m_s = 0.5 }
)");
  const Pose camera = scene.world_from(scene.cameras[0].mount, 2);
  expect_near(camera.position_m, {2, 0, 0});
  expect_near(camera.rotation * Vec3(0, 0, -1), {-std::sqrt(0.5), 0, -std::sqrt(0.5)});
  const auto lamp = [&](double t) { return scene.world_from(scene.lamps[0].mount, t); };
  expect_near(lamp(0).position_m, {1, 0, 0});
  expect_near(lamp(5).position_m, {2, 0, 0});
  expect_near(lamp(5).rotation * Vec3(0, 0, -1), {1, 0, 0});
  expect_near(lamp(9.5).rotation * Vec3(0, 0, -1), {0, 0, 1});
  expect_near(scene.world_from(scene.sonars[0].mount, 4).position_m, {0, -2, 0});
}

struct Case {
  const char* track;
  const char* message;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.message;
}

class TrackError : public testing::TestWithParam<Case> {};

std::string name_of(const testing::TestParamInfo<Case>& info) {
  return test::test_name(info.index, info.param.message);
}

TEST_P(TrackError, IsTheDocumentedLine) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "one.csv", "1,2,3").ok());
  ASSERT_TRUE(write_text(scratch / "five.csv", "1,2,3,4,5\n1,2,3,4,5").ok());
  ASSERT_TRUE(write_text(scratch / "mixed.csv", "1,2,3\n1,2,3,4").ok());
  ASSERT_TRUE(write_text(scratch / "back.csv", "t,x,y,z\n1,2,3,4\n1,2,3,4").ok());
  ASSERT_TRUE(write_text(scratch / "far.csv", "1,2,3,4\n2,1e9,0,0").ok());
  ASSERT_TRUE(write_text(scratch / "good.csv", "1,2,3,4\n2,2,3,5").ok());
  ASSERT_TRUE(write_text(scratch / "turns.csv", "1,2,3,4,0,0,0\n2,2,3,5,0,0,0").ok());
  ASSERT_TRUE(write_text(scratch / "s.toml", std::string("[[lamps]]\n") + GetParam().track).ok());
  const auto scene = load_scene(scratch / "s.toml");
  ASSERT_FALSE(scene.ok());
  std::string message = scene.error().message;
  const std::string folder = scratch.path().string() + "/";
  for (auto at = message.find(folder); at != std::string::npos; at = message.find(folder))
    message.erase(at, folder.size());
  EXPECT_EQ(message, GetParam().message);
}

#define TWO "waypoints_m = [[0,0,0],[1,0,0]]"
#define AREA "area_m = [0,0,1,1]"
#define WAY                                                                                  \
  "s.toml:2: lamps[0].track: found none or more than one of waypoints_m, lawn_mower, file, " \
  "recording; "                                                                              \
  "accepted: one of them"

INSTANTIATE_TEST_SUITE_P(
    Files, TrackError,
    testing::Values(
        Case{"track = {}", WAY}, Case{"track = {" TWO ", file = 'good.csv'}", WAY},
        Case{"track = 3", "s.toml:2: lamps[0].track: found 3; accepted: a table, under [track]"},
        Case{"track = {" TWO "}",
             "s.toml:2: lamps[0].track.speed_m_s: found nothing; accepted: a number in (0, 1000] "
             "m/s"},
        Case{"track = {" TWO ", speed_m_s = 0}",
             "s.toml:2: lamps[0].track.speed_m_s: found 0; accepted: a number in (0, 1000] m/s"},
        Case{"track = {" TWO ", speed_m_s = 1e-12}",
             "s.toml:2: lamps[0].track.speed_m_s: found 1e-12; accepted: a speed that ends the "
             "course in 1e+09 s"},
        Case{"track = {" TWO ", sped_m_s = 1}",
             "s.toml:2: lamps[0].track.sped_m_s: unknown key; nearest known key: speed_m_s"},
        Case{"track = {waypoints_m = [[0,0,0]], speed_m_s = 1}",
             "s.toml:2: lamps[0].track.waypoints_m: found [[...]]; accepted: 2 to 100000 lists "
             "of x, y, z"},
        Case{"track = {waypoints_m = [[0,0,0],[0,0,0]], speed_m_s = 1}",
             "s.toml:2: lamps[0].track: found a waypoint at the place of its neighbour; accepted: "
             "waypoints "
             "apart"},
        Case{"position_m = [0,0,1]\ntrack = {" TWO ", speed_m_s = 1}",
             "s.toml:2: lamps[0].position_m: found [0, 0, 1]; accepted: no such key beside track"},
        Case{"look_at_m = [0,0,1]\ntrack = {" TWO ", speed_m_s = 1}",
             "s.toml:2: lamps[0].look_at_m: found [0, 0, 1]; accepted: no such key beside a track "
             "unless its heading is \"fixed\""},
        Case{"track = {" TWO ", speed_m_s = 1, heading = 'north'}",
             "s.toml:2: lamps[0].track.heading: found \"north\"; accepted: one of along, fixed"},
        Case{
            "track = {" TWO ", speed_m_s = 1, heading = 'fixed', turn_m = 1}",
            "s.toml:2: lamps[0].track.turn_m: found 1; accepted: no such key unless the heading is "
            "along"},
        Case{"track = {file = 'one.csv', speed_m_s = 1}",
             "s.toml:2: lamps[0].track.file: one.csv: found 1 row; accepted: 2 or more"},
        Case{"track = {file = 'five.csv', speed_m_s = 1}",
             "s.toml:2: lamps[0].track.file: five.csv:1: found 5 numbers; accepted: x, y, z or "
             "t_s, x, y, "
             "z or t_s, x, y, z, yaw_deg, pitch_deg, roll_deg, the same in all rows"},
        Case{"track = {file = 'mixed.csv', speed_m_s = 1}",
             "s.toml:2: lamps[0].track.file: mixed.csv:2: found 4 numbers; accepted: x, y, z or "
             "t_s, x, "
             "y, z or t_s, x, y, z, yaw_deg, pitch_deg, roll_deg, the same in all rows"},
        Case{"track = {file = 'back.csv'}",
             "s.toml:2: lamps[0].track.file: back.csv:3: found time 1 after 1; accepted: rising "
             "times"},
        Case{"track = {file = 'far.csv'}",
             "s.toml:2: lamps[0].track.file: far.csv:2: found '1e9'; accepted: a number of at most "
             "4e+07"},
        Case{
            "track = {file = 'good.csv', speed_m_s = 1}",
            "s.toml:2: lamps[0].track.speed_m_s: found 1; accepted: no such key beside a file with "
            "times"},
        Case{"track = {file = 'turns.csv', heading = 'along'}",
             "s.toml:2: lamps[0].track.heading: found \"along\"; accepted: no such key beside a "
             "file with attitudes"},
        Case{"track = {speed_m_s = 1, lawn_mower = {" AREA ", depth_m = 1}}",
             "s.toml:2: lamps[0].track.lawn_mower.spacing_m: found nothing; accepted: a number of "
             "metres"},
        Case{"track = {speed_m_s = 1, lawn_mower = {" AREA ", depth_m = 1, spacing_m = 1e-6}}",
             "s.toml:2: lamps[0].track.lawn_mower.spacing_m: found 1e-06; accepted: a spacing that "
             "makes at most 50000 legs"},
        Case{"track = {speed_m_s = 1, lawn_mower = {area_m = [1,0,0,1]}}",
             "s.toml:2: lamps[0].track.lawn_mower.area_m: found [1, 0, 0, 1]; accepted: [x0, z0, "
             "x1, z1] in metres, with x0 < x1 and z0 < z1"}),
    name_of);

}  // namespace
}  // namespace neritic::scene
