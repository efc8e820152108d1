// A pane of tinted glass (KHR_materials_transmission) before a white wall, in air: what lies behind
// is seen through it in its colour, and stays in the arrays.
#include <gtest/gtest.h>

#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using Transmission = test::GpuTest;

void add_box(scene::Scene& scene, const scene::Material& material, double z_m, double thick_m,
             std::uint16_t id) {
  scene::Model box = scene::make_box({8.0, 8.0, thick_m});
  box.materials = {material};
  for (scene::Primitive& primitive : box.meshes[0].primitives) primitive.material = 0;
  scene.models.push_back(std::make_shared<scene::Model>(std::move(box)));
  scene::Object object;
  object.name = fmt::format("box {}", id);
  object.model = static_cast<int>(scene.models.size()) - 1;
  object.class_id = object.instance = id;
  object.mount.pose.position_m = {0.0, 0.0, z_m};
  scene.objects.push_back(object);
}

// passing: of the pane's light; none: no pane.
Result<ViewImages> picture(gpu::Device& device, std::optional<float> passing) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = radians(50.0), .azimuth_rad = kPi};
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = 17;
  camera.exposure.fixed_ev = 15.0;
  scene.cameras.push_back(camera);
  scene::Material wall, pane;
  wall.metallic = 0.0f;
  wall.base_color = Vec4f(0.6f, 0.6f, 0.6f, 1.0f);
  pane.metallic = 0.0f;
  pane.roughness = 0.1f;
  pane.transmissive = true;
  add_box(scene, wall, -5.0, 0.5, 1);
  if (passing) {
    pane.base_color = Vec4f(0.3f, 0.9f, 0.4f, 1.0f - *passing);
    add_box(scene, pane, -3.0, 0.01, 2);
  }
  NERITIC_TRY(const auto session, Session::create(device, std::move(scene)));
  FrameRequest request;
  request.cameras = {0};
  NERITIC_TRY(FrameResult result, session->render(request));
  return std::move(result.cameras[0].eyes[0]);
}

TEST_F(Transmission, TintedGlassShowsWhatLiesBehindInItsColour) {
  NERITIC_ASSERT_OK(const ViewImages plain, picture(device(), std::nullopt));
  NERITIC_ASSERT_OK(const ViewImages clear, picture(device(), 1.0f));
  NERITIC_ASSERT_OK(const ViewImages half, picture(device(), 0.5f));
  const auto channel = [](const ViewImages& eye, std::uint32_t c) {
    return static_cast<int>(eye.color.at(8, 8, c));
  };
  EXPECT_NEAR(channel(plain, 0), channel(plain, 1), 3);
  EXPECT_GT(channel(clear, 1), channel(clear, 0) + 40);  // green glass
  EXPECT_LT(channel(clear, 0), channel(plain, 0) - 40);
  EXPECT_GT(channel(clear, 0), 30);  // no black
  EXPECT_NE(channel(half, 0), channel(clear, 0));
  EXPECT_EQ(clear.depth.data, plain.depth.data);
  EXPECT_EQ(clear.labels.data, plain.labels.data);
}

}  // namespace
}  // namespace neritic::testbed
