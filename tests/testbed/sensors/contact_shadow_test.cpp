// The sun's shadow where a solid stands on the ground: dark up to its foot, on pictures.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using ContactShadow = test::GpuTest;

// A wall of 3 m on a level bed 8 m deep, seen from the west, with the sun in the east; the camera
// stands away_m before it.
scene::Scene wall_on_bed(double away_m, std::uint32_t step) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = radians(60.0), .azimuth_rad = radians(90.0)};
  scene.sun->shadows = scene::SunShadows{};
  scene.ambient = scene::Ambient{.bottom_depth_m = 8.0};
  scene.water = scene::Water{.type = "IB", .scattering = true};
  const auto add = [&](const Vec3& size_m, const Vec3& at_m) {
    scene.models.push_back(std::make_shared<scene::Model>(scene::make_box(size_m)));
    scene::Object object;
    object.name = fmt::format("box_{}", scene.objects.size());
    object.model = static_cast<int>(scene.models.size()) - 1;
    object.class_id = 1;
    object.instance = static_cast<std::uint16_t>(scene.objects.size() + 1);
    object.mount.pose.position_m = at_m;
    scene.objects.push_back(object);
  };
  add({80.0, 1.0, 80.0}, {0.0, -8.5, 0.0});
  add({0.3, 2.0, 3.0}, {0.0, -7.0, 0.0});
  scene::Camera camera;
  camera.name = "eye";
  camera.width = 320;
  camera.height = 240;
  camera.detail.visibility_step = step;
  camera.mount.pose = {Vec3(-0.15 - away_m, -7.2, 0.0),
                       glm::angleAxis(-0.5 * kPi, Vec3(0.0, 1.0, 0.0)) *
                           glm::angleAxis(radians(-12.0), Vec3(1.0, 0.0, 0.0))};
  scene.cameras.push_back(camera);
  return scene;
}

// The ground's green from the foot on: it may only grow lighter away from it.
TEST_F(ContactShadow, NoLitLineLiesBetweenAWallAndItsShadow) {
  for (const std::uint32_t step : {1u, 2u, 3u}) {
    // Levels of 8 bits. A shadow of the full resolution has fewer pixels to average.
    const int limit = step == 1 ? 6 : 3;
    for (const double away_m : {1.5, 2.0, 3.5, 6.0}) {
      NERITIC_ASSERT_OK(const auto session, Session::create(device(), wall_on_bed(away_m, step)));
      FrameRequest request;
      request.cameras = {0};
      NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
      const ViewImages& eye = result.cameras[0].eyes[0];
      for (const std::uint32_t x : {150u, 160u, 170u}) {
        std::uint32_t foot = 0;
        while (foot < 200 && eye.instances.at(x, foot) != 2) ++foot;
        while (foot < 200 && eye.instances.at(x, foot) == 2) ++foot;
        ASSERT_LT(foot, 200u) << away_m;
        for (std::uint32_t y = foot; y < foot + 3; ++y)
          for (std::uint32_t farther = y + 1; farther < foot + 12; ++farther)
            EXPECT_LE(eye.color.at(x, y, 1), eye.color.at(x, farther, 1) + limit)
                << "step " << step << ", " << away_m << " m, pixels " << y - foot << " and "
                << farther - foot << " below the foot";
      }
    }
  }
}

}  // namespace
}  // namespace neritic::testbed
