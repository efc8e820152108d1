// Light in water measured on pictures, the documented tone curve inverted, against closed forms:
// sight fades by exp(-c z) (Beer and Lambert), daylight by exp(-K_d d), the water's own light grows
// as B (1 - exp(-c z)), and its B is the integral of what is scattered once.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/render/lighting.hpp"
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

// At this exposure a white surface just under the water is about white.
constexpr double kFixed_ev = 15.0;
// The water alone is darker.
constexpr double kWater_ev = 12.5;

// A camera at depth_m that looks at a box of this albedo, face_m ahead (0: at nothing), in water
// with the sun behind it. pitch: up is positive.
struct View {
  const char* water = "IB";
  double depth_m = 3.0, face_m = 1.0, albedo = 1.0, pitch_rad = 0.0;
  bool scattering = false;
  double ev = kFixed_ev;
  bool auto_exposure = false;
};

scene::Scene scene_of(const View& view) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = radians(50.0), .azimuth_rad = kPi};
  scene.water = scene::Water{.type = view.water, .scattering = view.scattering};
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = 33;
  if (!view.auto_exposure) camera.exposure.fixed_ev = view.ev;
  camera.mount.pose = {Vec3(0.0, -view.depth_m, 0.0),
                       glm::angleAxis(view.pitch_rad, Vec3(1.0, 0.0, 0.0))};
  scene.cameras.push_back(camera);
  if (view.face_m == 0.0) return scene;
  scene::Model box = scene::make_box({20.0, 20.0, 1.0});
  scene::Material paint;
  paint.metallic = view.albedo == 0.0 ? 1.0f : 0.0f;  // a dielectric would mirror some light
  paint.base_color = Vec4f(Vec3f(static_cast<float>(view.albedo)), 1.0f);
  box.materials = {paint};
  for (scene::Primitive& primitive : box.meshes[0].primitives) primitive.material = 0;
  scene.models.push_back(std::make_shared<scene::Model>(std::move(box)));
  scene::Object object;
  object.name = "box";
  object.model = 0;
  object.class_id = object.instance = 1;
  object.mount.pose = {camera.mount.pose * Vec3(0.0, 0.0, -0.5 - view.face_m),
                       camera.mount.pose.rotation};
  scene.objects.push_back(object);
  return scene;
}

// Of the picture's middle; the test fails where eight bits are too coarse to tell.
Vec3 radiance_of(gpu::Device& device, const View& view) {
  auto session = Session::create(device, scene_of(view));
  EXPECT_TRUE(session.ok());
  if (!session.ok()) return Vec3(1.0);
  FrameRequest request;
  request.cameras = {0};
  const auto result = (*session)->render(request);
  EXPECT_TRUE(result.ok());
  if (!result.ok()) return Vec3(1.0);
  const ViewImages& eye = result->cameras[0].eyes[0];
  if (view.face_m > 0.0) {
    EXPECT_NEAR(eye.depth.at(16, 16), view.face_m, 1e-3);
  }
  Vec3 encoded;
  for (int ch = 0; ch < 3; ++ch) {
    const int value = eye.color.at(16, 16, ch);
    EXPECT_TRUE(value > 12 && value < 250) << view.water << " channel " << ch << ": " << value;
    encoded[ch] = value / 255.0;
  }
  return exposed_radiance(encoded);
}

TEST_F(WaterLight, OneMoreMetreOfWaterFadesByBeamAttenuation) {
  for (const char* type : {"IB", "III"}) {
    const Vec3 near = radiance_of(device(), {.water = type, .face_m = 1.0, .auto_exposure = true});
    const Vec3 far = radiance_of(device(), {.water = type, .face_m = 2.0, .auto_exposure = true});
    NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics(type));
    for (int ch = 0; ch < 3; ++ch) {
      const double wanted = std::exp(-optics.beam_attenuation_m()[ch]);
      EXPECT_NEAR(far[ch] / near[ch] / wanted, 1.0, 0.05) << type << " " << ch;
    }
  }
}

// The same plate, seen from half a metre above, deeper by 2 m. It is lit from the whole upper half
// space, so how much of the light is still a beam does not matter.
TEST_F(WaterLight, DaylightFadesWithDepthByDiffuseAttenuation) {
  for (const char* type : {"IB", "III"}) {
    Vec3 seen[2];
    for (int i = 0; i < 2; ++i)
      seen[i] = radiance_of(device(), {.water = type,
                                       .depth_m = 0.5 + 2.0 * i,
                                       .face_m = 0.5,
                                       .albedo = 0.8,
                                       .pitch_rad = -0.5 * kPi});
    NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics(type));
    for (int ch = 0; ch < 3; ++ch) {
      const double wanted = std::exp(-2.0 * optics.diffuse_attenuation_m[ch]);
      EXPECT_NEAR(seen[1][ch] / seen[0][ch] / wanted, 1.0, 0.03) << type << " " << ch;
    }
  }
}

// What the water before a black wall sends, against the water before nothing: level by the beam
// attenuation alone; down, where ever less light comes to be scattered, by c + K_d.
TEST_F(WaterLight, TheWatersOwnLightSaturatesWithTheLengthOfSight) {
  for (const double pitch_rad : {0.0, -0.5 * kPi})
    for (const char* type : {"III", "1C"}) {
      NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics(type));
      const View deep{.water = type,
                      .depth_m = 1.0,
                      .face_m = 0.0,
                      .pitch_rad = pitch_rad,
                      .scattering = true,
                      .ev = kWater_ev};
      const Vec3 forever = radiance_of(device(), deep);
      for (const double z_m : {2.0, 6.0}) {
        View wall = deep;
        wall.face_m = z_m;
        wall.albedo = 0.0;
        const Vec3 seen = radiance_of(device(), wall);
        for (int ch = 0; ch < 3; ++ch) {
          const double rate = optics.beam_attenuation_m()[ch] -
                              std::sin(pitch_rad) * optics.diffuse_attenuation_m[ch];
          EXPECT_NEAR(seen[ch] / forever[ch], 1.0 - std::exp(-rate * z_m), 0.03)
              << type << " " << ch << " at " << z_m << " m, pitch " << pitch_rad;
        }
      }
    }
}

// Henyey and Greenstein 1941; its integral over the sphere is 1.
double henyey_greenstein(double cosine, double g) {
  return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}
// Of sea water (Morel 1974).
double morel(double cosine) {
  return 3.0 / (4.0 * kPi * (3.0 + 0.835)) * (1.0 + 0.835 * cosine * cosine);
}

TEST_F(WaterLight, PhaseFunctionsScatterAllOfTheLight) {
  for (const double g : {0.6, 0.924}) {
    double sum = 0.0, mean = 0.0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = -1.0 + 2.0 * (i + 0.5) / kSteps;
      sum += 2.0 * kPi * henyey_greenstein(cosine, g) * 2.0 / kSteps;
      mean += 2.0 * kPi * henyey_greenstein(cosine, g) * cosine * 2.0 / kSteps;
    }
    EXPECT_NEAR(sum, 1.0, 1e-5);
    EXPECT_NEAR(mean, g, 1e-5);
  }
}

// The radiance of endless water by summing what each stretch of a level sight scatters once: of the
// sun's beam, and of the light that came out of it (shaders/shared/water.glsl says the model).
TEST_F(WaterLight, EndlessWaterShinesAsTheIntegralOfSingleScattering) {
  for (const char* type : {"II", "III"}) {
    const View view{
        .water = type, .depth_m = 1.0, .face_m = 0.0, .scattering = true, .ev = kWater_ev};
    const Vec3 seen = radiance_of(device(), view);
    const scene::Scene scene = scene_of(view);
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene_of(view)));
    const render::FrameState state =
        render::evaluate_frame(scene, session->gpu_scene(), 0.0, 0.1, false);
    NERITIC_ASSERT_OK(const shared::Lighting light,
                      render::make_lighting(scene, state, Vec3(0.0, -view.depth_m, 0.0),
                                            scene.cameras[0].exposure, false));
    NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics(type));
    const double to_sun = -light.to_sun.z;  // the sight's direction is -z
    for (int ch = 0; ch < 3; ++ch) {
      const double b = optics.particle_scattering_m[ch], water = optics.water_scattering_m[ch];
      const double down =
          light.surface_irradiance[ch] * std::exp(-optics.diffuse_attenuation_m[ch] * view.depth_m);
      const double beam = light.direct_share *
                          std::exp(-(b * (1.0 - 0.924) + water) * view.depth_m / light.sun_cosine);
      const double scattered =
          beam / light.sun_cosine * (b * henyey_greenstein(to_sun, 0.924) + water * morel(to_sun)) +
          (1.0 - beam) / 0.8 * (b * henyey_greenstein(0.0, 0.6) + water * morel(0.0));
      double sum = 0.0;
      constexpr double kStep_m = 0.01;
      for (double s = 0.5 * kStep_m; s < 400.0; s += kStep_m)
        sum += down * scattered * std::exp(-optics.beam_attenuation_m()[ch] * s) * kStep_m;
      EXPECT_NEAR(seen[ch] / (sum * light.exposure), 1.0, 0.04) << type << " " << ch;
    }
  }
}

}  // namespace
}  // namespace neritic::tools
