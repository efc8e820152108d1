// Light shafts fall on particles: snow in a roof's shadow loses the sun's beam, snow beside it
// keeps it, and under waves some flakes shine and others dim, while their mean stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/render/lighting.hpp"
#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using ParticleShaftsGpu = test::GpuTest;

struct Asked {
  bool roof = false, waves = false, shafts = false, snow = false;
};

// Clear water, the sun in the zenith, a camera 3 m deep that looks level; a roof over all that is
// to the left.
scene::Scene scene_of(const Asked& asked) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = radians(90.0)};
  if (asked.roof) scene.sun->shadows = scene::SunShadows{.size = 512, .cascades = 1};
  if (asked.waves) scene.sun->caustics = scene::Caustics{};
  if (asked.shafts) scene.sun->shafts = scene::Shafts{};
  scene.water = scene::Water{.type = "I", .scattering = true};
  if (asked.snow)
    scene.water->snow = scene::Snow{.density_m3 = 800.0, .diameter_m = 6e-3, .spread = 0.1};
  scene::Camera camera;
  camera.name = "eye";
  camera.width = 160;
  camera.height = 90;
  camera.exposure.fixed_ev = 14.0;
  camera.mount.pose.position_m = Vec3(0.0, -3.0, 0.0);
  camera.terms.linear = true;
  scene.cameras.push_back(camera);
  if (!asked.roof) return scene;
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box({20.0, 0.1, 40.0})));
  scene::Object roof;
  roof.name = "roof";
  roof.model = 0;
  roof.class_id = roof.instance = 1;
  roof.mount.pose.position_m = Vec3(-10.0, -0.5, 0.0);
  scene.objects.push_back(roof);
  return scene;
}

// Green light of the picture's pixels; empty after a failure.
ImageF32 picture(gpu::Device& device, const Asked& asked) {
  const auto session = Session::create(device, scene_of(asked));
  EXPECT_TRUE(session.ok());
  FrameRequest request;
  request.cameras = {0};
  auto result = (*session)->render(request);
  EXPECT_TRUE(result.ok()) << result.error().message;
  return result.ok() ? std::move(result->cameras[0].eyes[0].linear) : ImageF32{};
}

// Light that snow adds to each pixel, left of the roof's edge and right of it.
struct Added {
  double left = 0.0, right = 0.0;
};
Added added(gpu::Device& device, Asked asked) {
  asked.snow = true;
  const ImageF32 with = picture(device, asked);
  asked.snow = false;
  const ImageF32 without = picture(device, asked);
  Added sum;
  for (std::uint32_t y = 0; y < 90; ++y)
    for (std::uint32_t x = 0; x < 160; ++x)
      if (x < 70 || x >= 90)
        (x < 70 ? sum.left : sum.right) += with.at(x, y, 1) - without.at(x, y, 1);
  return sum;
}

TEST_F(ParticleShaftsGpu, SnowInARoofsShadowLosesTheBeamAndNoOther) {
  const Added lit = added(device(), {.roof = true, .shafts = true}),
              plain = added(device(), {.roof = true});
  EXPECT_NEAR(lit.right / plain.right, 1.0, 0.02);
  // The rest is the sky's: with the sun in the zenith and a level sight, a flake sends
  // on (0.33 + 0.67 / 2) of the beam over the beam's cosine, and 1.3 times the same of the sky.
  const auto lighting = render::make_lighting(scene_of({}), {}, Vec3(0.0, -3.0, 0.0), {}, false);
  ASSERT_TRUE(lighting.ok()) << lighting.error().message;
  const double turned = lighting->particle_scattering.y * 0.076 + lighting->water_scattering.y;
  const double direct = lighting->direct_share * std::exp(-3.0 * turned);
  const double sky = 1.3 * (1.0 - direct) / (direct + 1.3 * (1.0 - direct));
  EXPECT_NEAR(lit.left / plain.left, sky, 0.1);
}

TEST_F(ParticleShaftsGpu, SnowUnderWavesGlittersAboutTheSameMean) {
  const Added lit = added(device(), {.waves = true, .shafts = true}),
              plain = added(device(), {.waves = true});
  EXPECT_NEAR((lit.left + lit.right) / (plain.left + plain.right), 1.0, 0.08);
  EXPECT_GT(std::abs(lit.left / plain.left - lit.right / plain.right) +
                std::abs(lit.left / plain.left - 1.0),
            1e-3);
}

// Flakes that drift through the picture while the exposure lasts, small ones, whose opacity no cut
// limits.
TEST_F(ParticleShaftsGpu, AStreakOfSnowHasTheLightOfItsFlake) {
  const auto sum = [&](double density_m3, double shutter_s) {
    scene::Scene scene = scene_of({});
    scene.water->scattering = false;
    scene.water->snow = scene::Snow{.density_m3 = density_m3,
                                    .diameter_m = 1e-3,
                                    .spread = 0.0,
                                    .drift_m_s = Vec3(1.0, 0.0, 0.0),
                                    .shutter_s = shutter_s};
    const auto session = Session::create(device(), std::move(scene));
    EXPECT_TRUE(session.ok());
    FrameRequest request;
    request.cameras = {0};
    auto result = (*session)->render(request);
    EXPECT_TRUE(result.ok());
    const ImageF32& linear = result->cameras[0].eyes[0].linear;
    double light = 0.0;
    for (std::uint32_t y = 0; y < 90; ++y)
      for (std::uint32_t x = 0; x < 160; ++x) light += linear.at(x, y, 1);
    return light;
  };
  const double none = sum(1e-3, 0.0), still = sum(3000.0, 0.0) - none;
  ASSERT_GT(still, none);
  for (const double shutter_s : {0.01, 0.05, 0.1})
    EXPECT_NEAR((sum(3000.0, shutter_s) - none) / still, 1.0, 0.05) << shutter_s;
}

// Their number differs with each frame. A plan of its own for each took a tenth of a headset's
// frame.
TEST_F(ParticleShaftsGpu, FramesOfAnotherNumberOfParticlesShareOnePlan) {
  scene::Scene drifting = scene_of({.snow = true});
  drifting.water->snow->drift_m_s = Vec3(0.3, 0.0, 0.0);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), drifting));
  FrameRequest request;
  request.cameras = {0};
  std::vector<graph::GraphDecl> declared;
  for (const double time_s : {0.0, 0.5, 1.0, 1.5}) {
    request.time_s = time_s;
    graph::FrameGraph graph;
    NERITIC_ASSERT_OK(const auto frame, session->declare(graph, request));
    declared.push_back(graph.declaration());
  }
  const auto is_particles = [](const graph::PassDecl& pass) {
    return pass.name.ends_with("particles");
  };
  EXPECT_TRUE(std::ranges::any_of(declared[0].passes, is_particles));
  // The first frame may make what the later ones keep.
  EXPECT_TRUE(declared[2] == declared[1]);
  EXPECT_TRUE(declared[3] == declared[1]);
}

}  // namespace
}  // namespace neritic::testbed
