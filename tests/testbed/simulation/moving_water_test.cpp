// Vehicles of a scene in currents that change with time and place.
#include "engine/core/npy.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

// A scene's dive in a current from a grid over [-50, 50] x [-50, 0] x [-50, 50] m and 40 s: its
// corners' velocities, world axes. Linear between them. The vehicle weighs nothing in water.
TestDive dive_in_grid(const std::function<Vec3(const Vec3&, double)>& flow,
                      const std::string& keys) {
  const test::ScratchFolder scratch;
  std::vector<float> values;
  for (const double t : {0.0, 40.0})
    for (const double y : {-50.0, 0.0})
      for (const double z : {-50.0, 50.0})
        for (const double x : {-50.0, 50.0}) {
          const Vec3 v = flow({x, y, z}, t);
          for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(v[i]));
        }
  EXPECT_TRUE(write_npy(scratch / "flow.npy", values, {2, 2, 2, 2, 3}).ok());
  EXPECT_TRUE(write_text(scratch / "drifter.toml",
                         "include = \"" + vehicles_folder() +
                             "/bluerov2_heavy_dynamics.toml\"\nbuoyancy_n = 132.57\n"
                             "buoyancy_centre_m = [0, 0, 0]\n")
                  .ok());
  EXPECT_TRUE(write_text(scratch / "dive.toml",
                         "[physics]\n[current]\nkind = \"grid\"\nfile = \"flow.npy\"\n"
                         "origin_m = [-50, -50, -50]\nspacing_m = [100, 50, 100]\n"
                         "interval_s = 40\n[[vehicles]]\nshape = \"box\"\n"
                         "dynamics = \"drifter.toml\"\n" +
                             keys)
                  .ok());
  auto scene = scene::load_scene(scratch / "dive.toml");
  EXPECT_TRUE(scene.ok()) << scene.error().message;
  return dive_of(std::move(scene).value());
}

// A tide that sets in, from 0 to 2 m/s in 40 s: the vehicle goes along from the first moment.
TEST(MovingWater, AVehicleGoesWithATideThatSetsIn) {
  const Vec3 rate(0.05, 0.0, -0.02);
  TestDive dive = dive_in_grid([&](const Vec3&, double t) { return rate * t; },
                               "position_m = [-20, -10, 0]\nyaw_deg = 30\n");
  const Vec3 from = dive.pose().position_m;
  dive.run(30.0, [&] {
    const double t = dive.time_s();
    ASSERT_LT(glm::distance(dive.pose().position_m, from + rate * (0.5 * t * t)), 1e-5) << t;
  });
  EXPECT_EQ(dive.simulation->refused_states(), 0u);
}

// A diver who hovers goes along likewise, as nearly as breath and lead leave the density of water:
// drag alone would leave them behind by a third. Until they have turned and kick against it.
TEST(MovingWater, ADiverGoesWithATideThatSetsIn) {
  const Vec3 rate(0.05, 0.0, -0.02);
  const std::string assets = (test::source_dir() / "assets").string();
  TestDive dive = dive_in_grid([&](const Vec3&, double t) { return rate * t; },
                               "position_m = [-20, -10, 0]\n[[objects]]\nname = \"diver\"\n"
                               "class = \"diver\"\nmodel = \"" +
                                   assets + "/models/diver.glb\"\nhuman = \"" + assets +
                                   "/divers/recreational.toml\"\nposition_m = [0, -12, 0]\n"
                                   "pitch_deg = -90\n");
  const Vec3 from = rov::world_from_ned(dive.state().humans()[0].human.root.position_ned_m);
  dive.run(4.5, [&] {
    const double t = dive.time_s();
    const Vec3 way = rov::world_from_ned(dive.state().humans()[0].human.root.position_ned_m) - from;
    ASSERT_LT(glm::length(Vec3(way.x, 0.0, way.z) - rate * (0.5 * t * t)),
              0.02 + 0.06 * glm::length(rate) * t * t)
        << t;
  });
}

// Where the water turns about a point, u = w x r, what moves with it stays on its circle: the
// water's own acceleration, w x (w x r), holds it there. Without it drag alone would, and let it
// out.
TEST(MovingWater, AVehicleStaysOnTheCircleOfAnEddy) {
  const double turn_rad_s = 0.1;
  const auto eddy = [&](const Vec3& p, double) { return turn_rad_s * Vec3(p.z, 0.0, -p.x); };
  TestDive dive = dive_in_grid(eddy, "position_m = [10, -10, 0]\n");
  PhysicsState state = dive.world->start();
  state.vehicles()[0].body.velocity =  // body axes, yaw 0: forward is north, -z
      rov::vec6(glm::conjugate(state.vehicles()[0].body.attitude) *
                    rov::ned_from_world(eddy(Vec3(10, 0, 0), 0.0)),
                Vec3(0.0));
  for (std::uint64_t i = 0; i < 30 * 240; ++i) {
    state = dive.world->step(state, dive.world->start_inputs(), {i, dive.world->step_s()});
    const Vec3& at = state.vehicles()[0].body.position_ned_m;
    ASSERT_NEAR(std::hypot(at.x, at.y), 10.0, 0.02) << i;
  }
}

// Still water between two streams: what lies where the current is 0 has no force on it, however
// much it shears.
TEST(MovingWater, WhatRestsInAShearStays) {
  TestDive dive = dive_in_grid([](const Vec3& p, double) { return Vec3(0.02 * p.z, 0.0, 0.0); },
                               "position_m = [0, -10, 0]\n");
  dive.run(10.0);
  EXPECT_LT(glm::distance(dive.pose().position_m, Vec3(0, -10, 0)), 1e-12);
}

// A grid whose samples lie closer than the vehicle is long jumps by 100 m/s from one to the next:
// nothing there is refused, and nothing ends.
TEST(MovingWater, AGridThatJumpsLeavesFiniteStates) {
  scene::Scene scene = load_text("[physics]\n" + rov_text("position_m = [0, -10, 0]\n")).value();
  const test::ScratchFolder scratch;
  std::vector<float> values;
  for (int i = 0; i < 10 * 16 * 16 * 16 * 3; ++i)
    values.push_back(i * 7919 % 13 < 6 ? -57.0f : 57.0f);
  ASSERT_TRUE(write_npy(scratch / "jumps.npy", values, {10, 16, 16, 16, 3}).ok());
  scene.current = scene::Current{.kind = scene::Current::Kind::kGrid,
                                 .file = scratch / "jumps.npy",
                                 .origin_m = {-0.8, -10.8, -0.8},
                                 .spacing_m = {0.1, 0.1, 0.1},
                                 .interval_s = 0.3};
  TestDive dive = dive_of(std::move(scene));
  dive.run(5.0, [&] { ASSERT_LT(dive.speed_m_s(), 200.0); });
  EXPECT_EQ(dive.simulation->refused_states(), 0u);
  EXPECT_EQ(dive.vehicle().body.refused_inputs, 0u);
}

}  // namespace
}  // namespace neritic::testbed
