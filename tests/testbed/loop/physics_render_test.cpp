// Pictures along a dive: a vehicle's camera sees from where the physics has it, and drawing changes
// no bit of the physics.
#include <gtest/gtest.h>

#include <thread>

#include "rov/frames.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"
#include "tests/testbed/wall_flight.hpp"

namespace neritic::testbed {
namespace {

// The vehicle comes towards the wall.
scene::Scene scene_of_wall() {
  return wall_scene(R"(yaw_deg = 90
mission = { waypoints = [ { position_m = [-2, -10, 0] } ], look_at = "wall" }
[[vehicles.cameras]]
name = "eye"
position_m = [0, 0, -0.3]
width = 65
height = 65
[[vehicles.sonars]]
name = "sonar"
position_m = [0, 0, -0.3]
range_m = [0.2, 6.2]
azimuth_deg = 20
elevation_deg = 5
bins = [600, 33, 33]
)");
}

class PhysicsRender : public test::GpuTest {};

TEST_F(PhysicsRender, CamerasAndSonarsAreWhereTheVehicleIsAtTheTime) {
  scene::Scene scene = scene_of_wall();
  const auto world = PhysicsWorld::create(scene);
  ASSERT_TRUE(world.ok()) << world.error().message;
  auto physics = LivePhysics::create(scene, LivePhysics::Pace::kPicture);
  ASSERT_TRUE(physics.ok());
  auto session = Session::create(device(), scene);
  ASSERT_TRUE(session.ok()) << session.error().message;
  const auto simulation = (*world)->simulation({});
  for (const double time_s : {0.0, 1.5, 3.0, 5.0}) {
    while (simulation->newest().time_s < time_s - 1e-9) simulation->advance(1);
    const rov::State& body = simulation->newest().state.vehicles()[0].body;
    const Pose eye = rov::world_pose(body.position_ned_m, body.attitude) *
                     Pose{{0.0, 0.0, -0.3}, Quat(1.0, 0.0, 0.0, 0.0)};
    const double ahead_m = (eye.position_m.x + 4.0) / (eye.rotation * Vec3(0, 0, 1)).x;
    FrameRequest request;
    request.time_s = time_s;
    request.next_time_s = time_s + 1.0 / 30.0;
    request.cameras = request.sonars = {0};
    request.simulated = &(*physics)->motion();
    (*physics)->reach(request.time_s);
    (*physics)->reach(request.next_time_s);
    const auto frame = (*session)->render(request);
    ASSERT_TRUE(frame.ok()) << frame.error().message;
    const ViewImages& view = frame->cameras[0].eyes[0];
    EXPECT_NEAR(view.depth.at(32, 32, 0), ahead_m, 1e-4) << time_s;
    EXPECT_LT(glm::distance(view.world_from_view.position_m, eye.position_m), 1e-9);
    // The nearest sound is the wall's.
    const SonarFrame& sonar = frame->sonars[0];
    const auto& image = sonar.image.intensity;
    std::size_t first = 0;
    while (first < image.size() && !(image[first] > 0.0f)) ++first;
    EXPECT_NEAR(0.2 + 0.01 * (static_cast<double>(first / 33) + 0.5), ahead_m, 0.03) << time_s;
  }
}

TEST_F(PhysicsRender, DrawingChangesNoBitOfThePhysics) {
  scene::Scene scene = scene_of_wall();
  const auto alone = PhysicsWorld::create(scene);
  ASSERT_TRUE(alone.ok());
  auto live = LivePhysics::create(scene, LivePhysics::Pace::kPicture);
  ASSERT_TRUE(live.ok());
  auto session = Session::create(device(), scene);
  ASSERT_TRUE(session.ok()) << session.error().message;
  const auto simulation = (*alone)->simulation({});
  (*live)->start();
  for (int i = 0; i < 20; ++i) {
    FrameRequest request;
    request.time_s = request.next_time_s = i / 10.0;
    request.cameras = {0};
    (*live)->follow(0, request.time_s);
    request.simulated = &(*live)->motion();
    ASSERT_TRUE((*session)->render(request).ok());
    const auto& drawn = (*live)->newest();
    simulation->advance(drawn.step - simulation->newest().step);
    EXPECT_EQ(simulation->newest().hash, drawn.hash) << i;
  }
  EXPECT_GT(simulation->newest().step, 400u);
}

// With the renderer on and off in turn, beside busy cores (tools/repeat: a hundred times).
TEST_F(PhysicsRender, RunsDrawnAndNotHaveTheSameHashesBesideBusyCores) {
  std::vector<std::jthread> load;
  for (int i = 0; i < 2; ++i)
    load.emplace_back([](const std::stop_token& stop) {
      for (volatile double x = 1.0; !stop.stop_requested();) x = x * 1.0000001;
    });
  scene::Scene scene = scene_of_wall();
  auto session = Session::create(device(), scene);
  ASSERT_TRUE(session.ok()) << session.error().message;
  std::uint64_t first = 0;
  for (int run = 0; run < (test::is_thorough() ? 100 : 16); ++run) {
    auto live = LivePhysics::create(scene, LivePhysics::Pace::kPicture);
    ASSERT_TRUE(live.ok());
    (*live)->start();
    for (int i = 0; i <= 4; ++i) {
      FrameRequest request;
      request.time_s = request.next_time_s = 0.25 * i;
      request.cameras = request.sonars = {0};
      (*live)->follow(0, request.time_s);
      request.simulated = &(*live)->motion();
      if (run % 2 == 1) {
        ASSERT_TRUE((*session)->render(request).ok());
      }
    }
    ASSERT_GT((*live)->newest().step, 200u);
    if (run == 0) first = (*live)->newest().hash;
    ASSERT_EQ((*live)->newest().hash, first) << run;
  }
}

}  // namespace
}  // namespace neritic::testbed
