// Physics in scene files: what is said arrives, defaults follow the class, offsets move what is in
// the world, and every wrong line ends in its message.
#include <gtest/gtest.h>

#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

#define ROV "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\ndynamics = \"d.toml\"\n"
#define MISSION "[physics]\n" ROV "[vehicles.mission]\n"

class ScenePhysics : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(write_text(scratch_ / "d.toml", "mass_kg = 1\n").ok()); }
  test::ScratchFolder scratch_;
};

TEST_F(ScenePhysics, WithoutItsTableNothingIsSolidNorMoves) {
  const Scene scene = scene_of(scratch_, R"(
[[objects]]
class = "seabed"
shape = "plane"
)");
  EXPECT_FALSE(scene.physics.has_value());
  EXPECT_FALSE(scene.current.has_value());
  EXPECT_EQ(scene.objects[0].collision, Collision::kNone);
  EXPECT_FALSE(scene.objects[0].dynamics.has_value());
}

TEST_F(ScenePhysics, WhatIsSolidFollowsTheClassOrTheKey) {
  const Scene scene = scene_of(scratch_, R"(
[physics]
[classes]
dam = 40
[[objects]]
class = "wreck"
shape = "box"
[[objects]]
class = "diver"
shape = "box"
[[objects]]
class = "dam"
shape = "box"
collision = true
[[objects]]
class = "rock"
shape = "box"
collision = "hull"
[[objects]]
class = "pipe"
shape = "box"
collision = false
[[objects]]
class = "rock"
shape = "box"
track = { waypoints_m = [[0, 0, 0], [1, 0, 0]], speed_m_s = 1 }
)");
  const Collision expected[] = {Collision::kMesh, Collision::kNone, Collision::kMesh,
                                Collision::kHull, Collision::kNone, Collision::kNone};
  ASSERT_EQ(scene.objects.size(), std::size(expected));
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(scene.objects[i].collision, expected[i]) << i;
  EXPECT_EQ(scene.physics->rate_hz, 240.0);
  EXPECT_EQ(scene.physics->integrator, "guarded");
}

TEST_F(ScenePhysics, AMissionArrivesWithNamesResolvedAndOffsetsAdded) {
  const std::string text = R"(
[physics]
rate_hz = 480
integrator = "rk4"
water_kg_m3 = 1000
altitude_m = 1500
[current]
kind = "power_law"
velocity_m_s = [0.5, 0, -0.1]
depth_m = 20
exponent = 0.2
[[objects]]
name = "wreck"
shape = "box"
[[vehicles]]
name = "rov"
shape = "box"
dynamics = "d.toml"
position_m = [1, 2, 3]
failed_thrusters = [1, 4]
navigation = "truth"
tether_anchor_m = [0, 1, 0]
[vehicles.mission]
speed_m_s = 0.5
acceptance_m = 0.3
repeat = true
look_at = "wreck"
waypoints = [
  { position_m = [4, 5, 6], heading_deg = 90 },
  { position_m = [7, 8, 9], hold_s = 3 },
  { position_m = [1, 1, 1], look_at_m = [2, 2, 2], tilt = true },
]
)";
  const Vec3 offset(100, -1, 7);
  const Scene scene = scene_of(scratch_, text, {offset});
  EXPECT_EQ(scene.physics->rate_hz, 480.0);
  EXPECT_EQ(scene.physics->integrator, "rk4");
  EXPECT_EQ(scene.physics->water_kg_m3, 1000.0);
  EXPECT_EQ(scene.physics->altitude_m, 1500.0);
  EXPECT_EQ(scene.current->kind, Current::Kind::kPowerLaw);
  expect_near(scene.current->velocity_m_s, {0.5, 0, -0.1});
  EXPECT_EQ(scene.current->exponent, 0.2);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_FALSE(scene.objects[0].dynamics.has_value());
  ASSERT_TRUE(scene.objects[1].dynamics.has_value());
  const Dynamics& dynamics = *scene.objects[1].dynamics;
  EXPECT_EQ(dynamics.failed_thrusters, 0b1001u);
  EXPECT_EQ(dynamics.navigation, Dynamics::Navigation::kTruth);
  expect_near(*dynamics.tether_anchor_m, Vec3(0, 1, 0) + offset);
  ASSERT_TRUE(dynamics.mission.has_value());
  const Mission& mission = *dynamics.mission;
  EXPECT_EQ(mission.kind, Mission::Kind::kWaypoints);
  EXPECT_TRUE(mission.repeat);
  EXPECT_EQ(mission.speed_m_s, 0.5);
  EXPECT_EQ(mission.acceptance_m, 0.3);
  EXPECT_EQ(mission.facing.look_at->object, 0);
  ASSERT_EQ(mission.waypoints.size(), 3u);
  expect_near(mission.waypoints[0].position_m, Vec3(4, 5, 6) + offset);
  EXPECT_DOUBLE_EQ(*mission.waypoints[0].facing.heading_rad, radians(90.0));
  EXPECT_EQ(mission.waypoints[1].hold_s, 3.0);
  expect_near(mission.waypoints[2].facing.look_at->point_m, Vec3(2, 2, 2) + offset);
  EXPECT_TRUE(mission.waypoints[2].facing.tilt);
}

TEST_F(ScenePhysics, EveryKindOfMissionArrives) {
  const std::string start =
      "[[objects]]\nname = \"diver\"\nshape = \"box\"\n"
      "[[objects]]\nname = \"ship\"\nshape = \"box\"\n" MISSION;
  const auto mission = [&](const std::string& line) {
    return *scene_of(scratch_, start + line).objects.at(2).dynamics->mission;
  };
  EXPECT_EQ(mission("hold = \"station\"").kind, Mission::Kind::kStation);
  const Mission orbit = mission("orbit = { object = \"diver\", radius_m = 3, speed_m_s = -0.2 }");
  EXPECT_EQ(orbit.kind, Mission::Kind::kOrbit);
  EXPECT_EQ(orbit.target.object, 0);
  EXPECT_EQ(orbit.radius_m, 3.0);
  EXPECT_EQ(orbit.speed_m_s, -0.2);
  const Mission follow = mission("follow = { object = \"ship\", offset_m = [1, 2, 3] }");
  EXPECT_EQ(follow.kind, Mission::Kind::kFollow);
  EXPECT_EQ(follow.target.object, 1);
  expect_near(follow.offset_m, {1, 2, 3});
  const Mission between =
      mission("stand_between = { a = \"ship\", b = \"diver\", distance_m = 2.5 }");
  EXPECT_EQ(between.kind, Mission::Kind::kStandBetween);
  EXPECT_EQ(between.between_a.object, 1);
  EXPECT_EQ(between.between_b.object, 0);
  EXPECT_EQ(between.distance_m, 2.5);
}

TEST_F(ScenePhysics, InputsNameASourceForEachGroup) {
  const Scene scene = scene_of(scratch_, "[physics]\n" ROV R"(
inputs = { wrench = "joystick", fault = { from = "bench", hold_s = 5, then = "nobody" } }
)");
  const auto& inputs = scene.objects[0].dynamics->inputs;
  ASSERT_EQ(inputs.size(), 2u);
  EXPECT_EQ(inputs[0].group, "wrench");
  EXPECT_EQ(inputs[0].from, "joystick");
  EXPECT_FALSE(inputs[0].hold_s.has_value());
  EXPECT_EQ(inputs[0].then, "autopilot");
  EXPECT_EQ(inputs[1].from, "bench");
  EXPECT_EQ(inputs[1].hold_s, 5.0);
  EXPECT_EQ(inputs[1].then, "nobody");
}

struct WrongPhysics {
  const char* text;
  const char* message;
};
void PrintTo(const WrongPhysics& c, std::ostream* out) {
  *out << c.message;
}

class ScenePhysicsError : public testing::TestWithParam<WrongPhysics> {};

TEST_P(ScenePhysicsError, IsTheDocumentedLine) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "d.toml", "mass_kg = 1\n").ok());
  EXPECT_EQ(message_of(scratch, GetParam().text), GetParam().message);
}

std::string wrong_physics_name(const testing::TestParamInfo<WrongPhysics>& info) {
  return test::test_name(info.index, info.param.message);
}

#define BALL "[[objects]]\nname = \"ball\"\nshape = \"sphere\"\n"

INSTANTIATE_TEST_SUITE_P(
    All, ScenePhysicsError,
    testing::Values(
        WrongPhysics{"[physics]\nrate_hz = 30",
                     "s.toml:2: physics.rate_hz: found 30; accepted: a number in [60, 1000] hertz"},
        WrongPhysics{"[physics]\nintegrator = 'euler'",
                     "s.toml:2: physics.integrator: found \"euler\"; accepted: one of guarded, "
                     "rk4, semi_euler"},
        WrongPhysics{"[physics]\nmax_error_m = 1e-5\nrate_hz = 240",
                     "s.toml:3: physics.rate_hz: found 240; accepted: no such key beside "
                     "max_error_m"},
        WrongPhysics{"[physics]\nrate = 3",
                     "s.toml:2: physics.rate: unknown key; nearest known key: rate_hz"},
        WrongPhysics{"[current]\nkind = 'uniform'",
                     "s.toml:1: current: found a table; accepted: no such key in a scene without "
                     "[physics]"},
        WrongPhysics{"[physics]\n[current]\nvelocity_m_s = [1, 0, 0]",
                     "s.toml:2: current.kind: found nothing; accepted: one of uniform, power_law, "
                     "linear, grid"},
        WrongPhysics{
            "[physics]\n[current]\nkind = 'uniform'\nvelocity_m_s = [1, 0, 0]\ndepth_m = 3",
            "s.toml:5: current.depth_m: found 3; accepted: no such key of the kind uniform"},
        WrongPhysics{"[physics]\n[current]\nkind = 'linear'",
                     "s.toml:2: current.velocity_m_s: found nothing; accepted: [x, y, z] in m/s"},
        WrongPhysics{"[physics]\n[current]\nkind = 'grid'\nfile = 'none.npy'",
                     "s.toml:4: current.file: found \"none.npy\"; accepted: a file; none.npy is "
                     "none"},
        WrongPhysics{ROV,
                     "s.toml:4: vehicles[0].dynamics: found \"d.toml\"; accepted: no such key "
                     "in a scene without [physics]"},
        WrongPhysics{BALL "collision = true",
                     "s.toml:4: objects[0].collision: found true; accepted: no such key in a scene "
                     "without [physics]"},
        WrongPhysics{"[physics]\n" BALL "collision = 'box'",
                     "s.toml:5: objects[0].collision: found \"box\"; accepted: true, false or "
                     "\"hull\""},
        WrongPhysics{"[physics]\n" BALL "mission = { hold = 'station' }",
                     "s.toml:5: objects[0].mission: found a table; accepted: no such key without "
                     "dynamics"},
        WrongPhysics{"[physics]\n" BALL "dynamics = 'e.toml'",
                     "s.toml:5: objects[0].dynamics: found \"e.toml\"; accepted: a file; e.toml is "
                     "none"},
        WrongPhysics{"[physics]\n" ROV "copies = [[0, 0, 0]]",
                     "s.toml:6: vehicles[0].copies: found [[...]]; accepted: no such key beside "
                     "dynamics"},
        WrongPhysics{"[physics]\n[[vehicles]]\ndynamics = 'd.toml'\n[[vehicles.cameras]]",
                     "s.toml:3: vehicles[0].dynamics: found \"d.toml\"; accepted: no such key for "
                     "what is not drawn: what is drawn is its shape"},
        WrongPhysics{"[physics]\n" ROV "failed_thrusters = [0]",
                     "s.toml:6: vehicles[0].failed_thrusters: found [0]; accepted: a list "
                     "of the file's thrusters by number, each 1 to 16"},
        WrongPhysics{"[physics]\n" ROV "navigation = 'gps'",
                     "s.toml:6: vehicles[0].navigation: found \"gps\"; accepted: one of truth, "
                     "measured"},
        WrongPhysics{"[physics]\n" BALL "navigation = 'truth'",
                     "s.toml:5: objects[0].navigation: found \"truth\"; accepted: no such key "
                     "without dynamics"},
        WrongPhysics{MISSION,
                     "s.toml:6: vehicles[0].mission: found none of waypoints, hold, orbit, follow, "
                     "stand_between; accepted: one of them"},
        WrongPhysics{MISSION "hold = 'station'\nrepeat = true",
                     "s.toml:8: vehicles[0].mission.repeat: found true; accepted: no such key "
                     "without waypoints"},
        WrongPhysics{MISSION "waypoints = [{ heading_deg = 3 }]",
                     "s.toml:7: vehicles[0].mission.waypoints[0].position_m: found nothing; "
                     "accepted: [x, y, z] in metres"},
        WrongPhysics{"[physics]\n" BALL "inputs = { body = 'suit' }",
                     "s.toml:5: objects[0].inputs.body: unknown key; nearest known key: pose"},
        WrongPhysics{"[physics]\n" ROV "inputs = { body = 'suit' }",
                     "s.toml:6: vehicles[0].inputs.body: unknown key; nearest known key: fault"},
        WrongPhysics{"[physics]\n" ROV "inputs = { wrench = 'recording' }",
                     "s.toml:6: vehicles[0].inputs.wrench: found \"recording\"; accepted: "
                     "autopilot, nobody, or a source's name of up to 64 printable characters"},
        WrongPhysics{"[physics]\n" ROV "inputs = { wrench = 'simulation' }",
                     "s.toml:6: vehicles[0].inputs.wrench: found \"simulation\"; accepted: "
                     "autopilot, nobody, or a source's name of up to 64 printable characters"},
        WrongPhysics{"[physics]\n" ROV "inputs = { wrench = { hold_s = 3 } }",
                     "s.toml:6: vehicles[0].inputs.wrench.from: found nothing; accepted: "
                     "autopilot, nobody, or a source's name of up to 64 printable characters"},
        WrongPhysics{"[physics]\n" ROV "inputs = { wrench = { from = 'nobody', hold_s = 3 } }",
                     "s.toml:6: vehicles[0].inputs.wrench.hold_s: found 3; accepted: no such key "
                     "beside from = \"nobody\""},
        WrongPhysics{"[physics]\n" ROV "inputs = { wrench = { from = 'pad', then = 'pad' } }",
                     "s.toml:6: vehicles[0].inputs.wrench.then: found \"pad\"; accepted: one of "
                     "autopilot, nobody"},
        WrongPhysics{MISSION "waypoints = []",
                     "s.toml:7: vehicles[0].mission.waypoints: found []; accepted: 1 to "
                     "10000 tables with position_m"},
        WrongPhysics{MISSION "waypoints = [{ position_m = [0, 0, 0], tilt = true }]",
                     "s.toml:7: vehicles[0].mission.waypoints[0].tilt: found true; accepted: no "
                     "such key without look_at or look_at_m"},
        WrongPhysics{BALL MISSION "follow = { object = 'bull' }",
                     "s.toml:10: vehicles[0].mission.follow.object: found \"bull\"; accepted: the "
                     "name of another object or vehicle (nearest: ball)"},
        WrongPhysics{MISSION "follow = { object = 'rov' }",
                     "s.toml:7: vehicles[0].mission.follow.object: found \"rov\"; accepted: the "
                     "name of another object or vehicle"},
        WrongPhysics{MISSION "orbit = { radius_m = 3 }",
                     "s.toml:7: vehicles[0].mission.orbit: found none or both of object, point_m; "
                     "accepted: one of them"},
        WrongPhysics{BALL MISSION "stand_between = { a = 'ball', b = 'ball' }\nheading_deg = 3",
                     "s.toml:11: vehicles[0].mission.heading_deg: found 3; accepted: no such key "
                     "beside stand_between, which faces b"}),
    wrong_physics_name);

}  // namespace
}  // namespace neritic::scene
