// Light in water measured on pictures: the documented tone curve is inverted, and what a white wall
// sends through 2 m more of water has faded by exp(-2 c) in every channel (Beer and Lambert).
#include <gtest/gtest.h>

#include <cmath>

#include "engine/render/water_optics.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tools/session/session.hpp"

namespace neritic::tools {
namespace {

using WaterLight = test::GpuTest;

// The inverse of Hill's fit of the ACES transforms and of the sRGB encoding (IEC 61966-2-1).
Vec3 exposed_radiance(const Vec3& encoded) {
  const Mat3 from_srgb(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566,
                       0.83777);
  const Mat3 to_srgb(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605,
                     1.07602);
  Vec3 linear;
  for (int i = 0; i < 3; ++i)
    linear[i] =
        encoded[i] <= 0.04045 ? encoded[i] / 12.92 : std::pow((encoded[i] + 0.055) / 1.055, 2.4);
  Vec3 y = glm::inverse(to_srgb) * linear;
  for (int i = 0; i < 3; ++i) {
    // y = (v^2 + .0245786 v - .000090537) / (.983729 v^2 + .432951 v + .238081).
    const double a = 1.0 - 0.983729 * y[i], b = 0.0245786 - 0.432951 * y[i],
                 c = -0.000090537 - 0.238081 * y[i];
    y[i] = (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
  }
  return glm::inverse(from_srgb) * y / 1.8;
}

TEST_F(WaterLight, OneMoreMetreOfWaterFadesByBeamAttenuation) {
  for (const char* type : {"IB", "III"}) {
    Vec3 seen[2];
    for (int i = 0; i < 2; ++i) {
      scene::Scene scene;
      scene.path = "test";
      scene.sun =
          scene::Sun{.elevation_rad = radians(50.0), .azimuth_rad = kPi};  // behind the camera
      scene.water = scene::Water{.type = type};
      scene::Model wall = scene::make_box({20.0, 20.0, 1.0});
      scene::Material white;
      white.metallic = 0.0f;
      wall.materials = {white};
      for (scene::Primitive& primitive : wall.meshes[0].primitives) primitive.material = 0;
      scene.models.push_back(std::make_shared<scene::Model>(std::move(wall)));
      scene::Object object;
      object.name = "wall";
      object.model = 0;
      object.class_id = object.instance = 1;
      object.mount.pose.position_m = {0.0, -3.0, -0.5 - (i == 0 ? 1.0 : 2.0)};
      scene.objects.push_back(object);
      scene::Camera camera;
      camera.name = "eye";
      camera.width = camera.height = 33;
      camera.mount.pose.position_m = {0.0, -3.0, 0.0};
      scene.cameras.push_back(camera);
      FrameRequest request;
      request.cameras = {0};
      NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
      NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
      const ViewImages& eye = result.cameras[0].eyes[0];
      ASSERT_NEAR(eye.depth.at(16, 16), i == 0 ? 1.0 : 2.0, 1e-3);
      Vec3 encoded;
      for (int ch = 0; ch < 3; ++ch) {
        const int value = eye.color.at(16, 16, ch);
        ASSERT_GT(value, 20) << type << " " << ch;  // else eight bits are too coarse
        ASSERT_LT(value, 250) << type << " " << ch;
        encoded[ch] = value / 255.0;
      }
      seen[i] = exposed_radiance(encoded);
    }
    NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics(type));
    for (int ch = 0; ch < 3; ++ch) {
      const double wanted = std::exp(-optics.beam_attenuation_m()[ch]);
      EXPECT_NEAR(seen[1][ch] / seen[0][ch] / wanted, 1.0, 0.05) << type << " " << ch;
    }
  }
}

}  // namespace
}  // namespace neritic::tools
