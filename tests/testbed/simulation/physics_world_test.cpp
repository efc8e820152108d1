// A scene's physics against what is known of it: axes, currents, floating, falling; and the lines
// that end a scene whose physics cannot be.
#include <algorithm>

#include "rov/step_choice.hpp"
#include "testbed/record/dive_record.hpp"
#include "testbed/simulation/static_scene.hpp"
#include "tests/testbed/csv_text.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kPhysics = "[physics]\n";

TEST(PhysicsWorld, ASceneWithoutDynamicsNeedsNone) {
  auto scene = load_text(
      "[physics]\n[[objects]]\nshape = \"box\"\nclass = \"wreck\"\n"
      "[[cameras]]\n");
  ASSERT_TRUE(scene.ok());
  EXPECT_FALSE(PhysicsWorld::needed(*scene));
}

TEST(PhysicsWorld, StartsWhereTheSceneSaysInMarineAxes) {
  // East 3, up -10, south 2: north -2, east 3, down 10. Yaw -90 faces east: heading 90 degrees.
  const TestDive dive =
      dive_of(kPhysics + rov_text("position_m = [3, -10, 2]\nyaw_deg = -90\npitch_deg = 10\n"));
  const rov::State& body = dive.vehicle().body;
  EXPECT_EQ(body.position_ned_m, Vec3(-2, 3, 10));
  const Vec3 forward = body.attitude * Vec3(1, 0, 0);
  EXPECT_NEAR(forward.x, 0.0, 1e-12);
  EXPECT_NEAR(forward.y, std::cos(radians(10.0)), 1e-12);
  EXPECT_NEAR(forward.z, -std::sin(radians(10.0)), 1e-12);  // pitched up
  const Pose back = dive.pose(), scene = dive.scene.world_from(dive.scene.objects[0].mount);
  EXPECT_EQ(back.position_m, scene.position_m);
  EXPECT_GT(glm::dot(back.rotation, scene.rotation), 1.0 - 1e-15);
}

TEST(PhysicsWorld, SurgeHeaveAndYawMoveItAsTheSceneSeesThem) {
  const auto moved_by = [](std::size_t axis, double amount) {
    TestDive dive = dive_of(kPhysics + rov_text("position_m = [0, -10, 0]\nyaw_deg = -90\n"));
    Piloting inputs;
    inputs.piloted = 1;
    inputs.pilot[axis] = amount;
    pilot(dive, 0, inputs);
    dive.run(2.0);
    return dive.pose();
  };
  EXPECT_GT(moved_by(0, 20.0).position_m.x, 0.3);    // forward is east
  EXPECT_GT(moved_by(1, 20.0).position_m.z, 0.2);    // starboard is south
  EXPECT_LT(moved_by(2, 30.0).position_m.y, -10.2);  // down
  const double heading = heading_deg(moved_by(5, 2.0));
  EXPECT_GT(heading, 100.0);  // clockwise
  EXPECT_LT(heading, 260.0);
}

// A vehicle without weight in water takes on the water's velocity, wherever the current is from.
TEST(PhysicsWorld, WhatDriftsTakesOnTheCurrentOfItsPlace) {
  const auto velocity_of = [](const std::string& current, double depth_m) {
    const test::ScratchFolder scratch;
    EXPECT_TRUE(write_text(scratch / "neutral.toml",
                           "include = \"" + vehicles_folder() +
                               "/bluerov2_heavy_dynamics.toml\"\nbuoyancy_n = 132.57\n"
                               "linear_damping = [13.7, 10, 33, 0.1, 0.8, 0.1]\n")
                    .ok());
    const std::string text = fmt::format(
        "[physics]\n[current]\n{}\n[[vehicles]]\nshape = \"box\"\ndynamics = \"neutral.toml\"\n"
        "position_m = [1, {}, 2]\nyaw_deg = 30\n",
        current, -depth_m);
    EXPECT_TRUE(write_text(scratch / "dive.toml", text).ok());
    TestDive dive = dive_of(scene::load_scene(scratch / "dive.toml").value());
    dive.run(120.0);
    return dive.pose().rotation * rov::world_from_ned(dive.vehicle().body.velocity.linear());
  };
  const Vec3 uniform = velocity_of("kind = \"uniform\"\nvelocity_m_s = [0.3, 0, -0.2]", 10.0);
  EXPECT_LT(glm::distance(uniform, Vec3(0.3, 0, -0.2)), 2e-3);
  const Vec3 power = velocity_of(
      "kind = \"power_law\"\nvelocity_m_s = [0.4, 0, 0]\ndepth_m = 20\nexponent = 0.5", 15.0);
  EXPECT_LT(glm::distance(power, Vec3(0.2, 0, 0)), 2e-3);
  const Vec3 linear = velocity_of(
      "kind = \"linear\"\nvelocity_m_s = [0.4, 0, 0]\ndeep_velocity_m_s = [0, 0, 0.2]\n"
      "depth_m = 40",
      10.0);
  EXPECT_LT(glm::distance(linear, Vec3(0.3, 0, 0.05)), 2e-3);
}

// Nobody steers: it rises in sea water and floats with so much of its height out of the water that
// what is left bears its weight, m g = (1 - share) B.
TEST(PhysicsWorld, WhatRisesFloatsAtItsDraught) {
  TestDive dive = dive_of(kPhysics + rov_text("position_m = [0, -1, 0]\n"));
  dive.run(120.0);
  const rov::Vehicle& vehicle = dive.world->vehicles()[0].vehicle;
  const double share = 1.0 - vehicle.weight_n / vehicle.buoyancy_n;
  ASSERT_GT(share, 0.0);
  EXPECT_NEAR(dive.pose().position_m.y + 0.13, share * 0.26, 1e-4);  // its top over the water
  EXPECT_LT(dive.speed_m_s(), 1e-3);
}

TEST(PhysicsWorld, ThrustersOutOfTheWaterPushNothing) {
  TestDive dive = dive_of(kPhysics + rov_text("position_m = [0, -1, 0]\n"));
  Piloting inputs;
  inputs.piloted = 1;
  inputs.pilot[2] = -400.0;  // up, with all that it has: more than its weight
  pilot(dive, 0, inputs);
  double highest_m = -1.0;
  dive.run(30.0, [&] { highest_m = std::max(highest_m, dive.pose().position_m.y); });
  EXPECT_GT(highest_m, 0.0);
  EXPECT_LT(highest_m, 1.5);
}

struct WrongScene {
  std::string text, message;
};

TEST(PhysicsWorld, WhatCannotBeEndsInOneLine) {
  const std::string wreck =
      "[[objects]]\nname = \"wreck\"\nclass = \"wreck\"\nshape = \"box\"\nsize_m = [4, 4, 4]\n"
      "position_m = [0, -10, 0]\n";
  const WrongScene cases[] = {
      {kPhysics + wreck + rov_text("position_m = [0.2, -10.1, 0]\n"), "dive.toml: rov: starts 1.9"},
      {kPhysics + wreck + rov_text("position_m = [0.2, -10.1, 0]\n"),
       "m deep in wreck; accepted: a place in the water"},
      {kPhysics + rov_text("failed_thrusters = [3, 9]\n"),
       "rov: failed_thrusters: thruster 9 found; accepted: 1 to 8, as "},
      {kPhysics + rov_text("tether_anchor_m = [0, 0, 0]\n"),
       "rov: tether_anchor_m found; accepted: no such key, since "},
  };
  for (const WrongScene& wrong : cases) {
    auto scene = load_text(wrong.text);
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const auto world = PhysicsWorld::create(*scene);
    ASSERT_FALSE(world.ok()) << wrong.message;
    EXPECT_EQ(world.error().code, ErrorCode::kBadInput);
    EXPECT_NE(world.error().message.find(wrong.message), std::string::npos)
        << world.error().message;
    EXPECT_EQ(world.error().message.find('\n'), std::string::npos);
  }
}

TEST(PhysicsWorld, AParameterFileWithNegativeMassEndsInOneLine) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "bad.toml", "mass_kg = -3\ninertia_kg_m2 = [1, 1, 1]\n").ok());
  ASSERT_TRUE(write_text(scratch / "dive.toml",
                         "[physics]\n[[vehicles]]\nshape = \"box\"\ndynamics = \"bad.toml\"\n")
                  .ok());
  const auto world = PhysicsWorld::create(scene::load_scene(scratch / "dive.toml").value());
  ASSERT_FALSE(world.ok());
  EXPECT_EQ(world.error().code, ErrorCode::kBadInput);
  EXPECT_NE(world.error().message.find("mass_kg"), std::string::npos) << world.error().message;
  EXPECT_EQ(world.error().message.find('\n'), std::string::npos);
}

TEST(PhysicsWorld, TheIntegratorsThatScenesNameAreThoseOfVehicles) {
  for (const char* name : {"guarded", "rk4", "semi_euler"}) {
    EXPECT_TRUE(rov::integrator_of(name).ok()) << name;
    EXPECT_TRUE(load_text(fmt::format("[physics]\nintegrator = \"{}\"\n", name)).ok()) << name;
  }
}

TEST(PhysicsWorld, AnErrorChoosesTheStep) {
  const auto world_of = [](const char* error, const char* more = "") {
    auto scene =
        load_text(fmt::format("[physics]\nmax_error_m = {}\n{}", error, more) + rov_text(""));
    EXPECT_TRUE(scene.ok());
    return PhysicsWorld::create(*scene);
  };
  EXPECT_NEAR((*world_of("3e-3"))->step_s(), 1.0 / 80.0, 1e-12);
  EXPECT_NEAR((*world_of("2e-3"))->step_s(), 1.0 / 240.0, 1e-12);
  EXPECT_NEAR((*world_of("1e-3"))->step_s(), 1.0 / 500.0, 1e-12);
  EXPECT_NEAR((*world_of("2e-7"))->step_s(), 1.0 / 1000.0, 1e-12);
  EXPECT_EQ((*world_of("2e-7"))->method().contact_error_m, 0.0);
  const auto refused = world_of("1e-15");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("dive.toml: physics.max_error_m: found 1e-15"),
            std::string::npos)
      << refused.error().message;
  // Where something can be touched, the steps that touch it are halved.
  const char* wall = "[[objects]]\nclass = 'structure'\nshape = 'box'\nposition_m = [0, -5, -9]\n";
  const auto among = world_of("1e-3", wall);
  ASSERT_TRUE(among.ok());
  EXPECT_NEAR((*among)->step_s(), 1.0 / 500.0, 1e-12);
  EXPECT_EQ((*among)->method().contact_error_m, 1e-4);
  const auto better = world_of("1e-5", wall);
  ASSERT_TRUE(better.ok());
  EXPECT_LT((*better)->method().contact_error_m, 1e-5);
  const auto too_good = world_of("1e-6", wall);
  ASSERT_FALSE(too_good.ok());
  EXPECT_NE(too_good.error().message.find("accepted: a number from 1e-05 where something solid"),
            std::string::npos)
      << too_good.error().message;
  // A mesh with inner edges, as a wreck's, holds less, and its scene is told so.
  const std::string wreck = "[[objects]]\nclass = 'wreck'\nmodel = '" +
                            (test::source_dir() / "assets/models/submarine.glb").string() +
                            "'\nposition_m = [0, -30, -9]\n";
  const auto at_wreck = world_of("1e-5", wreck.c_str());
  ASSERT_FALSE(at_wreck.ok());
  EXPECT_NE(at_wreck.error().message.find("where uneven ground or a mesh with inner edges"),
            std::string::npos)
      << at_wreck.error().message;
}

// Without noise each sensor says what the state is; the ground that it hears is the scene's.
TEST(PhysicsWorld, SensorsWithoutNoiseSayWhatIsSo) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "sensors.toml",
                         "include = \"" + vehicles_folder() +
                             "/bluerov2_heavy_dynamics.toml\"\n[dvl]\nrate_hz = 240\n"
                             "[altimeter]\nrate_hz = 240\n[pressure]\nrate_hz = 240\n"
                             "water_kg_m3 = 1028\n[compass]\nrate_hz = 240\n[usbl]\n"
                             "rate_hz = 240\n[imu]\n")
                  .ok());
  ASSERT_TRUE(write_text(scratch / "dive.toml", R"([physics]
altitude_m = 2000
[[objects]]
name = "sand"
class = "seabed"
shape = "plane"
size_m = [60, 60]
position_m = [0, -12, 0]
[[vehicles]]
name = "rov"
shape = "box"
dynamics = "sensors.toml"
position_m = [0, -9, 0]
mission = { waypoints = [ { position_m = [3, -8, -2] } ] }
)")
                  .ok());
  TestDive dive = dive_of(scene::load_scene(scratch / "dive.toml").value());
  DiveRecorder recorder(*dive.world, {.rows = true});
  recorder.add(dive.simulation->newest());
  dive.run(6.0, [&] { recorder.add(dive.simulation->newest()); });
  ASSERT_GT(recorder.rows().vehicles.size(), 290u);
  for (const DiveRow& row : recorder.rows().vehicles) {
    const rov::SensorReadings& read = row.readings;
    const Pose& pose = row.world_from_body;
    ASSERT_TRUE(read.dvl.value.locked());
    EXPECT_LT(glm::distance(read.dvl.value.velocity_m_s, row.velocity.linear()), 1e-9);
    EXPECT_NEAR(read.pressure.value.depth_m, -pose.position_m.y, 1e-9);
    // A lake at 2000 m: the standard atmosphere's 79.5 kPa over it.
    EXPECT_NEAR(read.pressure.value.pressure_pa, 79495.0 - 1028.0 * 9.82 * pose.position_m.y, 2.0);
    EXPECT_NEAR(std::remainder(degrees(read.heading_rad.value) - heading_deg(pose), 360.0), 0.0,
                1e-9);
    const double down = (pose.rotation * Vec3(0, 1, 0)).y;
    EXPECT_NEAR(read.altimeter.value.distance_m, (12.0 + pose.position_m.y) / down, 1e-6);
    EXPECT_LT(glm::distance(rov::world_from_ned(read.usbl.value.position_ned_m), pose.position_m),
              1e-6);
  }
  const std::string csv = csv_of(*dive.world, recorder.rows());
  for (const char* column : {",gyro_yaw_deg_s", ",dvl_altitude_m", ",pressure_depth_m",
                             ",compass_deg", ",altimeter_m", ",usbl_z_m"})
    EXPECT_NE(csv.find(column), std::string::npos) << column;
  // Every row has a cell for every column.
  const auto commas = std::count(csv.begin(), std::find(csv.begin(), csv.end(), '\n'), ',');
  EXPECT_EQ(std::count(csv.begin(), csv.end(), ','),
            commas * static_cast<std::ptrdiff_t>(recorder.rows().vehicles.size() + 1));
}

// Solid are the copies where they stand, of every kind of placement, and only what stands still.
TEST(StaticScene, ThingsAreWhereTheSceneDrawsThem) {
  auto scene = load_text(R"(
[physics]
[[objects]]
name = "stretched"
class = "rock"
shape = "box"
scale = [1, 2, 3]
copies = [[0, 0, 0], [10, 0, 0, 90], [20, 0, 0, 0, 2]]
position_m = [0, -20, 0]
[[objects]]
name = "truck"
shape = "sphere"
track = { waypoints_m = [[0, 0, 50], [5, 0, 50]], speed_m_s = 1 }
[[objects]]
name = "load"
class = "rock"
shape = "box"
on = "truck"
[[objects]]
name = "bowl"
shape = "box"
collision = "hull"
position_m = [0, -20, 30]
roll_deg = 45
)");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  const auto world = static_world_of(*scene);
  ASSERT_TRUE(world.ok()) << world.error().message;
  EXPECT_EQ(world->counts().things, 4u);
  const auto top = [&](double x, double z) {
    const auto hit = world->cast({x, 0, z}, {0, -1, 0}, 100.0);
    return hit ? -hit->distance_m : -100.0;
  };
  EXPECT_NEAR(top(0, 0), -19.0, 1e-5);  // a cube of a metre, twice as high
  EXPECT_NEAR(top(0, 1.4), -19.0, 1e-5);
  EXPECT_EQ(top(1.4, 0.1), -100.0);
  EXPECT_NEAR(top(11.4, 0.1), -19.0, 1e-5);  // turned
  EXPECT_EQ(top(10.1, 1.4), -100.0);
  EXPECT_NEAR(top(20, 2.9), -18.0, 1e-5);  // twice as large
  EXPECT_EQ(top(0, 50), -100.0);
  EXPECT_NEAR(top(0, 30), -20.0 + std::sqrt(0.5), 1e-5);
  const auto hit = world->cast({20, 0, 0}, {0, -1, 0}, 100.0);
  EXPECT_EQ(hit->label, scene->objects[0].instance + 2u);
}

// A terrain is a grid of heights: what is below it is inside.
TEST(StaticScene, ATerrainIsSolidBelowAsItIsDrawn) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "slope.asc",
                         "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                         "0 1 2\n0 1 2\n0 1 2\n")
                  .ok());
  for (const char* scale : {"", "scale = [2, 3, 2]\n", "scale = [2, 3, 1]\n"}) {
    auto scene = load_text(
        fmt::format("[physics]\n[[objects]]\nname = 'sand'\nclass = 'seabed'\nterrain = '{}'\n"
                    "position_m = [0, -20, 0]\n{}",
                    (folder / "slope.asc").string(), scale));
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const auto world = static_world_of(*scene);
    ASSERT_TRUE(world.ok()) << world.error().message;
    EXPECT_EQ(world->counts().triangles, 8u) << scale;
    const double steep = *scale ? 1.5 : 1.0;
    const auto hit = world->cast({5.0, 0.0, 1.0}, {0, -1, 0}, 100.0);
    ASSERT_TRUE(hit.has_value()) << scale;
    EXPECT_NEAR(-hit->distance_m, -20.0 + (*scale ? 3.0 : 1.0) + 0.1 * steep * 5.0, 1e-5) << scale;
    // Three metres down: inside, but under a mesh, which it is where its cells are not square.
    sim::BodyShape ball;
    ball.add_sphere(Vec3(0.0), 0.1);
    sim::ContactMemory memory;
    const auto contacts =
        world->contacts(ball, {{5.0, -22.0, 1.0}, Quat(1, 0, 0, 0)}, 0.01, memory);
    const bool square = std::string_view(scale) != "scale = [2, 3, 1]\n";
    ASSERT_EQ(contacts.size(), square ? 1u : 0u) << scale;
    EXPECT_EQ(square, !contacts.empty() && contacts[0].inside) << scale;
  }
}

}  // namespace
}  // namespace neritic::testbed
