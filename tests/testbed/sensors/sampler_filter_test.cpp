// glTF's filters on pictures: how a texture is minified and magnified is what its sampler says,
// each for itself, with and without mips.
#include <gtest/gtest.h>

#include <set>

#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/sensors/wall_scene.hpp"

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
  scene::Material material;
  material.unlit = true;
  material.base_color_texture.texture = 0;
  const double pixel_m = 2.0 * std::tan(radians(15.0)) / kPixels;  // of a wall 1 m ahead
  const auto repeats = static_cast<float>(texels_per_pixel / (pixel_m * kTexels));
  material.base_color_texture.transform_u = {repeats, 0, 0};
  material.base_color_texture.transform_v = {0, repeats, 0};
  scene::Model wall = test::wall_of(material);
  wall.images.push_back(std::move(texture));
  wall.textures.push_back({0, sampler});
  scene::Scene scene = test::wall_scene(std::move(wall), kPixels);
  scene.cameras[0].vertical_fov_rad = radians(30.0);
  NERITIC_TRY(const ImageU8 color, test::picture_of(device, std::move(scene)));
  std::set<int> levels;
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
