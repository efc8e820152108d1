// Vertex colours are linear, as glTF says, and as fine in the dark as the picture is.
#include <gtest/gtest.h>

#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/sensors/wall_scene.hpp"

namespace neritic::testbed {
namespace {

using VertexColor = test::GpuTest;

// The grey level in the middle of a wall that shines with the linear value: by its vertices'
// colours or by its material's.
Result<int> level_of(gpu::Device& device, float linear, bool by_vertices) {
  const Vec4f color(linear, linear, linear, 1.0f);
  scene::Material material;
  material.unlit = true;
  if (!by_vertices) material.base_color = color;
  scene::Model wall = test::wall_of(material);
  if (by_vertices)
    for (scene::Primitive& primitive : wall.meshes[0].primitives)
      primitive.colors.assign(primitive.positions.size(), color);
  NERITIC_TRY(const ImageU8 picture,
              test::picture_of(device, test::wall_scene(std::move(wall), 16)));
  return int{picture.at(8, 8, 1)};
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
