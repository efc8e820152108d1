// Light in water measured on pictures, the documented tone curve and gamut mapping inverted,
// against closed forms: sight fades by exp(-c z) (Beer and Lambert), daylight by exp(-K_d d), the
// water's own light grows as B (1 - exp(-c z)), and its B is the integral of what is scattered
// once; so are the lamps' beams, and lamps light what they reach by exp(-c z) / z^2. Snell's window
// lets in all the light there is.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <span>

#include "engine/render/lighting.hpp"
#include "engine/render/water_optics.hpp"
#include "engine/scene/shapes.hpp"
#include "shared/gamut.h"
#include "shared/phase.h"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/oklab.hpp"

namespace neritic::testbed {
namespace {

using WaterLight = test::GpuTest;

// Chroma as it was before the mapping into the gamut: with w = (r - k) / (1 - k) of the colour
// displayed, x = w / (1 - w) (shaders/shared/gamut.h).
Vec3 before_gamut(const Vec3& linear) {
  constexpr double k = shared::kGamutKnee;
  test::Lch colour = test::oklab(linear);
  const double edge = test::edge_chroma(colour.lightness, colour.hue_rad);
  if (colour.chroma <= k * edge) return linear;
  const double w = (colour.chroma / edge - k) / (1.0 - k);
  colour.chroma = (k + (1.0 - k) * w / (1.0 - w)) * edge;
  return test::linear_srgb(colour);
}

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
  Vec3 y = glm::inverse(to_srgb) * before_gamut(linear);
  for (int i = 0; i < 3; ++i) {
    // y = (v^2 + 0.0245786 v - 0.000090537) / (0.983729 v^2 + 0.432951 v + 0.238081).
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
  // Instead of the sun: a lamp here in the camera's axes, that shines as the camera looks.
  double lamp_cd = 0.0;
  Vec3 lamp_m{0.0};
};

// Its cone is so wide that all that is looked at is lit in full.
scene::Lamp lamp_of(const View& view, const Pose& camera) {
  scene::Lamp lamp;
  lamp.intensity_cd = view.lamp_cd;
  lamp.inner_cone_rad = radians(88.0);
  lamp.outer_cone_rad = radians(89.0);
  lamp.mount.pose = {camera * view.lamp_m, camera.rotation};
  return lamp;
}

scene::Scene scene_of(const View& view) {
  scene::Scene scene;
  scene.path = "test";
  if (view.lamp_cd == 0.0)
    scene.sun = scene::Sun{.elevation_rad = radians(50.0), .azimuth_rad = kPi};
  scene.water = scene::Water{.type = view.water, .scattering = view.scattering};
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = 33;
  if (!view.auto_exposure) camera.exposure.fixed_ev = view.ev;
  camera.mount.pose = {Vec3(0.0, -view.depth_m, 0.0),
                       glm::angleAxis(view.pitch_rad, Vec3(1.0, 0.0, 0.0))};
  scene.cameras.push_back(camera);
  if (view.lamp_cd > 0.0) scene.lamps.push_back(lamp_of(view, camera.mount.pose));
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

// The radiance in the picture's middle; the test fails if eight bits are too coarse.
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

// Open water by daylight, for which cameras expose: clipped channels would show neon green (5C) and
// ultramarine (I). Photographs of daylight have a median of 0.0 % of such pixels.
TEST_F(WaterLight, NoChannelOfOpenWaterIsAtTheGamutsEdgeInAnyType) {
  for (const std::string_view name : scene::kWaterTypes) {
    const std::string type(name);
    scene::Scene scene = scene_of({.water = type.c_str(),
                                   .depth_m = 5.0,
                                   .face_m = 0.0,
                                   .scattering = true,
                                   .auto_exposure = true});
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
    FrameRequest request;
    request.cameras = {0};
    NERITIC_ASSERT_OK(const auto result, session->render(request));
    for (int ch = 0; ch < 3; ++ch) {
      const int value = result.cameras[0].eyes[0].color.at(16, 16, ch);
      EXPECT_TRUE(value > 0 && value < 255) << type << " channel " << ch << ": " << value;
    }
  }
}

// Cameras expose for the water: in photographs it has a luma of about 110, and 5 % of all their
// pixels lie below 56.
TEST_F(WaterLight, AutoExposureMakesOpenWaterAMidTone) {
  for (const char* type : {"IB", "II", "III", "1C", "3C", "5C", "7C"})
    for (const double depth_m : {5.0, 15.0}) {
      NERITIC_ASSERT_OK(const auto session,
                        Session::create(device(), scene_of({.water = type,
                                                            .depth_m = depth_m,
                                                            .face_m = 0.0,
                                                            .scattering = true,
                                                            .auto_exposure = true})));
      FrameRequest request;
      request.cameras = {0};
      NERITIC_ASSERT_OK(const auto result, session->render(request));
      const ImageU8& color = result.cameras[0].eyes[0].color;
      const double luma =
          0.299 * color.at(16, 16, 0) + 0.587 * color.at(16, 16, 1) + 0.114 * color.at(16, 16, 2);
      EXPECT_GT(luma, 60.0) << type << " " << depth_m;
      EXPECT_LT(luma, 145.0) << type << " " << depth_m;
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

// Light from the water before a black wall, relative to the water before nothing: level by the beam
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
// Scattering of sea water (Morel 1974).
double morel(double cosine) {
  return 3.0 / (4.0 * kPi * (3.0 + 0.835)) * (1.0 + 0.835 * cosine * cosine);
}

// The shaders' own, which are C++ too.
TEST(WaterPhase, FunctionsScatterAllOfTheLightByTheirMeanCosine) {
  const struct {
    std::function<double(float)> phase;
    double mean;
  } functions[] = {
      {[](float c) { return shared::henyey_greenstein(c, shared::kParticleG); }, 0.924},
      {[](float c) { return shared::henyey_greenstein(c, shared::kDiffuseG); }, 0.6},
      {[](float c) { return shared::sea_water_phase(c); }, 0.0}};
  for (const auto& function : functions) {
    double sum = 0.0, mean = 0.0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = -1.0 + 2.0 * (i + 0.5) / kSteps;
      const double share = 2.0 * kPi * function.phase(static_cast<float>(cosine)) * 2.0 / kSteps;
      sum += share;
      mean += share * cosine;
    }
    EXPECT_NEAR(sum, 1.0, 1e-4) << function.mean;
    EXPECT_NEAR(mean, function.mean, 1e-4);
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

// A lamp beside the camera on a wall: I / z^2 arrives, less what 2 z of water take.
TEST_F(WaterLight, ALampsLightFadesByTheSquareAndTheWaterBothWays) {
  constexpr double kLamp_cd = 1000.0, kAlbedo = 0.8;
  NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics("II"));
  for (const double z_m : {1.0, 3.0}) {
    const double ev = z_m == 1.0 ? 8.0 : 3.5;
    const Vec3 seen = radiance_of(device(), {.water = "II",
                                             .depth_m = 20.0,
                                             .face_m = z_m,
                                             .albedo = kAlbedo,
                                             .ev = ev,
                                             .lamp_cd = kLamp_cd});
    for (int ch = 0; ch < 3; ++ch) {
      const double wanted = kLamp_cd / (z_m * z_m) * kAlbedo / kPi *
                            std::exp(-2.0 * optics.beam_attenuation_m()[ch] * z_m);
      EXPECT_NEAR(seen[ch] / (wanted * std::exp2(-ev)), 1.0, 0.04) << z_m << " m, " << ch;
    }
  }
}

// From a metre above the surface on a plate half a metre below it: half a metre of water each way.
TEST_F(WaterLight, ALampInTheAirIsDimmedByTheWatersPartOfTheWay) {
  constexpr double kLamp_cd = 1000.0, kAlbedo = 0.8, kEv = 7.5;
  NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics("III"));
  const Vec3 seen = radiance_of(device(), {.water = "III",
                                           .depth_m = -1.0,
                                           .face_m = 1.5,
                                           .albedo = kAlbedo,
                                           .pitch_rad = -0.5 * kPi,
                                           .ev = kEv,
                                           .lamp_cd = kLamp_cd});
  for (int ch = 0; ch < 3; ++ch) {
    const double wanted = kLamp_cd / (1.5 * 1.5) * kAlbedo / kPi *
                          std::exp(-2.0 * optics.beam_attenuation_m()[ch] * 0.5);
    EXPECT_NEAR(seen[ch] / (wanted * std::exp2(-kEv)), 1.0, 0.04) << ch;
  }
}

// Backscatter of a lamp beside and behind the eye, to_m of the sight
// being in water: the sum over the sight of I / r^2, scattered once, dimmed over both legs.
Vec3 glow_integral(const View& view, const render::WaterOptics& optics, double to_m) {
  constexpr double kStep_m = 0.001;
  Vec3 sum(0.0);
  for (double t_m = 0.5 * kStep_m; t_m < to_m; t_m += kStep_m) {
    const Vec3 leg_m = Vec3(0.0, 0.0, -t_m) - view.lamp_m;
    const double r_m = glm::length(leg_m), cosine = leg_m.z / r_m;  // back to the eye is +z
    for (int ch = 0; ch < 3; ++ch)
      sum[ch] += view.lamp_cd / (r_m * r_m) *
                 (optics.particle_scattering_m[ch] * henyey_greenstein(cosine, 0.924) +
                  optics.water_scattering_m[ch] * morel(cosine)) *
                 std::exp(-optics.beam_attenuation_m()[ch] * (t_m + r_m)) * kStep_m;
  }
  return sum;
}

// The shader takes four samples a lamp: within 5 % here.
TEST_F(WaterLight, ALampsBeamGlowsAsTheIntegralOfSingleScattering) {
  NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics("III"));
  // Deep down and level; then up from 0.7 m below the surface, where the water ends.
  for (const bool up : {false, true}) {
    const View view{.water = "III",
                    .depth_m = up ? 0.7 : 20.0,
                    .face_m = 0.0,
                    .pitch_rad = up ? 0.5 * kPi : 0.0,
                    .scattering = true,
                    .ev = 2.0,
                    .lamp_cd = 5000.0,
                    .lamp_m = {0.5, 0.0, 0.3}};
    const Vec3 seen = radiance_of(device(), view);
    const Vec3 wanted = glow_integral(view, optics, up ? 0.7 : 40.0);
    for (int ch = 0; ch < 3; ++ch)
      EXPECT_NEAR(seen[ch] / (wanted[ch] * std::exp2(-view.ev)), 1.0, 0.05) << up << " " << ch;
  }
}

TEST_F(WaterLight, AirDoesNotGlow) {
  for (const double pitch_rad : {0.0, 0.5}) {
    const View view{.water = "III",
                    .depth_m = -0.5,
                    .face_m = 0.0,
                    .pitch_rad = pitch_rad,
                    .scattering = true,
                    .ev = 2.0,
                    .lamp_cd = 5000.0,
                    .lamp_m = {0.5, 0.0, 0.3}};
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene_of(view)));
    FrameRequest request;
    request.cameras = {0};
    NERITIC_ASSERT_OK(const auto result, session->render(request));
    for (int ch = 0; ch < 3; ++ch)
      EXPECT_EQ(result.cameras[0].eyes[0].color.at(16, 16, ch), 0) << pitch_rad;
  }
}

// The radiance of every pixel, from pictures at several exposures: the brightest that eight bits
// hold. Pixels that all of them are too bright or too dark for are 0.
Result<std::vector<Vec3>> radiance_map(Session& session, std::span<const double> evs) {
  std::vector<Vec3> map;
  for (const double ev : evs) {
    FrameRequest request;
    const scene::MotionSource motion(session.scene());
    request.views = {{.name = "map",
                      .views = camera_views(motion, session.scene().cameras[0]),
                      .exposure = {.fixed_ev = ev},
                      .capture = Capture{.motion = false}.without_geometry()}};
    NERITIC_TRY(const FrameResult result, session.render(request));
    const ImageU8& color = result.views[0].eyes[0].color;
    map.resize(std::size_t{color.width} * color.height, Vec3(0.0));
    for (std::size_t i = 0; i < map.size(); ++i) {
      const std::uint8_t* rgb = &color.data[3 * i];
      if (map[i] != Vec3(0.0) || std::max({rgb[0], rgb[1], rgb[2]}) > 245) continue;
      map[i] = exposed_radiance(Vec3(rgb[0], rgb[1], rgb[2]) / 255.0) * std::exp2(ev);
    }
  }
  return map;
}

// Just below the surface and looking up: radiance times cosine over all directions is the
// irradiance that the surface lets through, of sky and sun alike (Mobley 1994, ch. 4).
TEST_F(WaterLight, SnellsWindowLetsInAllTheLight) {
  const View view{.water = "IB", .depth_m = 0.02, .face_m = 0.0, .pitch_rad = 0.5 * kPi};
  scene::Scene scene = scene_of(view);
  scene.water->surface = true;
  scene.cameras[0].near_m = 0.005;  // its window is under water too
  constexpr std::uint32_t kSide = 201;
  scene.cameras[0].width = scene.cameras[0].height = kSide;
  scene.cameras[0].vertical_fov_rad = radians(110.0);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  const render::FrameState state =
      render::evaluate_frame(scene, session->gpu_scene(), 0.0, 0.1, false);
  NERITIC_ASSERT_OK(const shared::Lighting light,
                    render::make_lighting(scene, state, Vec3(0.0, -view.depth_m, 0.0),
                                          scene.cameras[0].exposure, false));
  const double evs[] = {14.5, 17.0, 19.5, 22.0, 24.5};
  NERITIC_ASSERT_OK(const std::vector<Vec3> map, radiance_map(*session, evs));
  NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics("IB"));
  constexpr Vec3 kLuminance{0.2126, 0.7152, 0.0722};           // ITU-R BT.709
  const double pixel = 2.0 * std::tan(radians(55.0)) / kSide;  // on a plane at distance 1
  double sum = 0.0, wanted = 0.0;
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const double u = (x + 0.5) * pixel - std::tan(radians(55.0)),
                   v = (y + 0.5) * pixel - std::tan(radians(55.0));
      const double cosine = 1.0 / std::sqrt(1.0 + u * u + v * v);
      const double solid_angle_sr = pixel * pixel * cosine * cosine * cosine;
      for (int ch = 0; ch < 3; ++ch)
        sum += kLuminance[ch] * map[y * kSide + x][ch] * cosine * solid_angle_sr *
               std::exp(optics.beam_attenuation_m()[ch] * view.depth_m / cosine);
    }
  for (int ch = 0; ch < 3; ++ch) wanted += kLuminance[ch] * light.surface_irradiance[ch];
  EXPECT_NEAR(sum / wanted, 1.0, 0.03);
  // The sky alone, at the zenith: n^2 times the air's radiance, less some 2 % at the surface. A
  // clear sky is brighter at the horizon: as (0.8 + 0.6 (1 - sine)^2) / 0.9 of its mean.
  const Vec3 zenith = map[kSide / 2 * kSide + kSide / 2];
  const double reflected = std::pow((1.333 - 1.0) / (1.333 + 1.0), 2.0);
  const double air = wanted * (1.0 - light.direct_share) / 0.934 / kPi;
  EXPECT_NEAR(glm::dot(kLuminance, zenith) / (1.333 * 1.333 * (1.0 - reflected) * air), 0.8 / 0.9,
              0.04);
}

}  // namespace
}  // namespace neritic::testbed
