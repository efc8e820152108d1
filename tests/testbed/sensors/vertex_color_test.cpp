// Vertex colours are linear, as glTF says, and as fine in the dark as the picture is.
#include <gtest/gtest.h>

#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using VertexColor = test::GpuTest;

// The grey level in the middle of a wall that shines with the linear value: by its vertices'
// colours or by its material's.
Result<int> level_of(gpu::Device& device, float linear, bool by_vertices) {
  scene::Model model = scene::make_box({4.0, 4.0, 1.0});
  const Vec4f color(linear, linear, linear, 1.0f);
  scene::Material material;
  material.unlit = true;
  if (!by_vertices) material.base_color = color;
  model.materials = {material};
  for (scene::Primitive& primitive : model.meshes[0].primitives) {
    primitive.material = 0;
    if (by_vertices) primitive.colors.assign(primitive.positions.size(), color);
  }
  scene::Scene scene;
  scene.path = "test";
  scene.models.push_back(std::make_shared<scene::Model>(std::move(model)));
  scene::Object object;
  object.model = 0;
  object.mount.pose.position_m = {0.0, 0.0, -1.5};
  scene.objects.push_back(object);
  scene::Camera camera;
  camera.width = camera.height = 16;
  scene.cameras.push_back(camera);
  NERITIC_TRY(const auto session, Session::create(device, std::move(scene)));
  FrameRequest request;
  request.cameras = {0};
  NERITIC_TRY(const FrameResult result, session->render(request));
  return int{result.cameras[0].eyes[0].color.at(8, 8, 1)};
}

TEST_F(VertexColor, DarkOnesShowAsTheMaterialsColourOfThatValue) {
  int before = -2;
  // Halves of a 255th among them, which 8 bits could not tell from their neighbours.
  for (const float n_255ths : {0.0f, 1.0f, 1.5f, 2.0f, 2.5f, 3.0f, 60.0f, 255.0f}) {
    const float linear = n_255ths / 255.0f;
    NERITIC_ASSERT_OK(const int by_vertices, level_of(device(), linear, true));
    NERITIC_ASSERT_OK(const int by_material, level_of(device(), linear, false));
    EXPECT_NEAR(by_vertices, by_material, 1) << n_255ths;
    EXPECT_GT(by_material, before + 1) << n_255ths;
    before = by_material;
  }
}

}  // namespace
}  // namespace neritic::testbed
