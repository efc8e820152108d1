// A material's detail texture: its blue changes the base colour, its red and green add to the
// normal map, and it repeats on its own.
#include <gtest/gtest.h>

#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/sensors/wall_scene.hpp"

namespace neritic::testbed {
namespace {

using DetailTexture = test::GpuTest;

ImageU8 one_pixel(int red, int green, int blue) {
  ImageU8 image(1, 1, 4, 255);
  image.at(0, 0, 0) = static_cast<std::uint8_t>(red);
  image.at(0, 0, 1) = static_cast<std::uint8_t>(green);
  image.at(0, 0, 2) = static_cast<std::uint8_t>(blue);
  return image;
}

// The picture, 32 pixels square, of a wall 1 m ahead in air of the material, whose pictures these
// are; the sun stands to the right of the camera.
Result<ImageU8> picture_of(gpu::Device& device, const scene::Material& material,
                           std::vector<ImageU8> pictures) {
  scene::Model wall = test::wall_of(material);
  for (ImageU8& picture : pictures) {
    wall.textures.push_back({static_cast<int>(wall.images.size()), {}});
    wall.textures.back().sampler.mag_linear = false;
    wall.images.push_back(std::move(picture));
  }
  for (scene::Primitive& primitive : wall.meshes[0].primitives)
    primitive.tangents.assign(primitive.positions.size(), Vec4f(1, 0, 0, 1));
  scene::Scene scene = test::wall_scene(std::move(wall), 32);
  scene.sun = scene::Sun{.elevation_rad = radians(20.0), .azimuth_rad = radians(135.0)};
  scene.cameras[0].vertical_fov_rad = 2.0 * std::atan(0.5);  // 1 m of the wall
  scene.cameras[0].exposure.fixed_ev = 14.0;
  return test::picture_of(device, std::move(scene));
}

TEST_F(DetailTexture, BlueChangesTheBaseColourByItsValue) {
  scene::Material plain;
  plain.unlit = true;
  for (const int blue : {64, 128, 192}) {
    const float gain = static_cast<float>(blue) / 127.5f;
    scene::Material detailed = plain;
    detailed.base_color = Vec4f(0.2f, 0.3f, 0.4f, 1.0f);
    detailed.detail_texture.texture = 0;
    scene::Material wanted = plain;
    wanted.base_color = Vec4f(gain * Vec3f(0.2f, 0.3f, 0.4f), 1.0f);
    NERITIC_ASSERT_OK(const ImageU8 is,
                      picture_of(device(), detailed, {one_pixel(128, 128, blue)}));
    NERITIC_ASSERT_OK(const ImageU8 should, picture_of(device(), wanted, {}));
    for (std::uint32_t c = 0; c < 3; ++c) EXPECT_NEAR(is.at(16, 16, c), should.at(16, 16, c), 1);
  }
}

TEST_F(DetailTexture, RedAndGreenAddToTheNormalMap) {
  const auto lit = [&](const ImageU8& normal, const ImageU8& detail) -> Result<int> {
    scene::Material material;
    material.metallic = 0.0f;
    material.base_color = Vec4f(0.4f, 0.4f, 0.4f, 1.0f);
    material.normal_texture.texture = 0;
    material.detail_texture.texture = 1;
    NERITIC_TRY(const ImageU8 picture, picture_of(device(), material, {normal, detail}));
    return int{picture.at(16, 16, 1)};
  };
  const ImageU8 level = one_pixel(128, 128, 255), none = one_pixel(128, 128, 128);
  // Tilted by 0.3 towards the sun, in one picture or half in each, or away from it; z is level.
  const ImageU8 right = one_pixel(166, 128, 255), half = one_pixel(147, 128, 255);
  NERITIC_ASSERT_OK(const int flat, lit(level, none));
  NERITIC_ASSERT_OK(const int by_normal, lit(right, none));
  NERITIC_ASSERT_OK(const int by_detail, lit(level, one_pixel(166, 128, 128)));
  NERITIC_ASSERT_OK(const int by_both, lit(half, one_pixel(147, 128, 128)));
  NERITIC_ASSERT_OK(const int away, lit(level, one_pixel(90, 128, 128)));
  EXPECT_GT(by_normal, flat + 5);
  EXPECT_LT(away, flat - 5);
  EXPECT_NEAR(by_detail, by_normal, 1);
  EXPECT_NEAR(by_both, by_normal, 1);
}

TEST_F(DetailTexture, RepeatsApartFromTheOtherTextures) {
  ImageU8 halves(2, 1, 4, 255);
  for (std::uint32_t c = 0; c < 3; ++c) halves.at(0, 0, c) = 60, halves.at(1, 0, c) = 200;
  scene::Material material;
  material.unlit = true;
  material.base_color = Vec4f(0.3f, 0.3f, 0.3f, 1.0f);
  material.detail_texture.texture = 0;
  material.detail_texture.transform_u *= 4.0f;  // every 0.25 m, of which 1 m is seen
  NERITIC_ASSERT_OK(const ImageU8 picture, picture_of(device(), material, {halves}));
  int steps = 0;
  for (std::uint32_t x = 1; x < 32; ++x)
    steps += std::abs(int{picture.at(x, 16, 1)} - int{picture.at(x - 1, 16, 1)}) > 20 ? 1 : 0;
  EXPECT_NEAR(steps, 8, 1);
}

}  // namespace
}  // namespace neritic::testbed
