// glTF's filters on pictures: how a texture is minified and magnified is what its sampler says,
// each for itself, with and without mips.
#include <gtest/gtest.h>

#include <set>

#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using SamplerFilter = test::GpuTest;

constexpr std::uint32_t kTexels = 256;

// Black and white texels.
ImageU8 checkerboard(std::uint32_t width, std::uint32_t height) {
  ImageU8 board(width, height, 4, 255);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      for (std::uint32_t c = 0; c < 3; ++c) board.at(x, y, c) = (x + y) % 2 ? 255 : 0;
  return board;
}

// The grey levels that a wall shows whose texture repeats so that kTexels are so many pixels.
Result<std::set<int>> levels_of(gpu::Device& device, const scene::Sampler& sampler,
                                double texels_per_pixel,
                                ImageU8 texture = checkerboard(kTexels, kTexels)) {
  constexpr std::uint32_t kPixels = 40;
  scene::Model model = scene::make_box({4.0, 4.0, 1.0});  // texture coordinates in metres
  model.images.push_back(std::move(texture));
  model.textures.push_back({0, sampler});
  scene::Material material;
  material.unlit = true;
  material.base_color_texture.texture = 0;
  const double pixel_m = 2.0 * std::tan(radians(15.0)) / kPixels;  // of a wall 1 m ahead
  const auto repeats = static_cast<float>(texels_per_pixel / (pixel_m * kTexels));
  material.base_color_texture.transform_u = {repeats, 0, 0};
  material.base_color_texture.transform_v = {0, repeats, 0};
  model.materials = {material};
  for (scene::Primitive& primitive : model.meshes[0].primitives) primitive.material = 0;

  scene::Scene scene;
  scene.path = "test";
  scene.models.push_back(std::make_shared<scene::Model>(std::move(model)));
  scene::Object object;
  object.model = 0;
  object.mount.pose.position_m = {0.0, 0.0, -1.5};
  scene.objects.push_back(object);
  scene::Camera camera;
  camera.width = camera.height = kPixels;
  camera.vertical_fov_rad = radians(30.0);
  scene.cameras.push_back(camera);
  NERITIC_TRY(const auto session, Session::create(device, std::move(scene)));
  FrameRequest request;
  request.cameras = {0};
  NERITIC_TRY(const FrameResult result, session->render(request));
  std::set<int> levels;
  const ImageU8& color = result.cameras[0].eyes[0].color;
  for (std::uint32_t y = 0; y < kPixels; ++y)
    for (std::uint32_t x = 0; x < kPixels; ++x) levels.insert(color.at(x, y, 1));
  return levels;
}

constexpr scene::Sampler sampler_of(bool mag_linear, bool min_linear) {
  scene::Sampler sampler;
  sampler.mag_linear = mag_linear;
  sampler.min_linear = min_linear;
  sampler.mip_linear = sampler.mipmapped = false;
  return sampler;
}

TEST_F(SamplerFilter, WithoutMipsTheMinFilterMinifies) {
  // Between 1 and 2 texels a pixel, so that linear samples lie between texels.
  NERITIC_ASSERT_OK(const auto nearest, levels_of(device(), sampler_of(true, false), 1.7));
  EXPECT_EQ(nearest.size(), 2u);  // black and white, nothing between
  NERITIC_ASSERT_OK(const auto linear, levels_of(device(), sampler_of(false, true), 1.7));
  EXPECT_GT(linear.size(), 20u);
}

TEST_F(SamplerFilter, WithoutMipsTheMagFilterMagnifies) {
  NERITIC_ASSERT_OK(const auto nearest, levels_of(device(), sampler_of(false, true), 0.3));
  EXPECT_EQ(nearest.size(), 2u);
  NERITIC_ASSERT_OK(const auto linear, levels_of(device(), sampler_of(true, false), 0.3));
  EXPECT_GT(linear.size(), 20u);
}

// A texture wider than the device takes is halved: of a checkerboard the mean is left, by the
// squares of the colours, which are nearly linear light.
TEST_F(SamplerFilter, TooWideATextureIsHalved) {
  const std::uint32_t wide = device().limits().maxImageDimension2D + 2;
  NERITIC_ASSERT_OK(const auto halved,
                    levels_of(device(), sampler_of(false, false), 1.0, checkerboard(wide, 2)));
  ImageU8 grey(1, 1, 4, 255);
  for (std::uint32_t c = 0; c < 3; ++c) grey.at(0, 0, c) = 180;  // 255 / sqrt(2)
  NERITIC_ASSERT_OK(const auto wanted, levels_of(device(), sampler_of(false, false), 1.0, grey));
  EXPECT_EQ(halved, wanted);
  EXPECT_EQ(halved.size(), 1u);
}

TEST_F(SamplerFilter, MipsOfAFineCheckerboardAreGrey) {
  NERITIC_ASSERT_OK(const auto levels, levels_of(device(), scene::Sampler{}, 8.0));
  EXPECT_LE(*levels.rbegin() - *levels.begin(), 2);
  EXPECT_GT(*levels.begin(), 60);
}

}  // namespace
}  // namespace neritic::testbed
