// Light as a scene names it: shadows lie where geometry puts them, caustics keep the sun's energy
// and come to a focus where a lens's formula says, an even furnace stays even, and what is not
// named is not in the graph.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>

#include "engine/render/caustic_waves.hpp"
#include "engine/render/lighting.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/shapes.hpp"
#include "engine/scene/sun_position.hpp"
#include "shared/phase.h"
#include "shared/visibility.h"
#include "testbed/sensors/readback.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using Light = test::GpuTest;

void add_box(scene::Scene& scene, const Vec3& size_m, const Vec3& place_m) {
  scene::Model box = scene::make_box(size_m);
  scene::Material paint;
  paint.metallic = 0.0f;
  paint.base_color = Vec4f(0.5f, 0.5f, 0.5f, 1.0f);
  box.materials = {paint};
  for (scene::Primitive& primitive : box.meshes[0].primitives) primitive.material = 0;
  scene.models.push_back(std::make_shared<scene::Model>(std::move(box)));
  scene::Object object;
  object.name = fmt::format("box {}", scene.objects.size());
  object.model = static_cast<int>(scene.models.size()) - 1;
  object.class_id = 1;
  object.instance = static_cast<std::uint16_t>(scene.objects.size() + 1);
  object.mount.pose.position_m = place_m;
  scene.objects.push_back(object);
}

// A floor at 0, in air, seen from 10 m above through a picture of 0.05 m a pixel; the sun stands in
// the east at 45 degrees, and a slab of 4 x 4 m hovers at 2 m.
scene::Scene floor_and_slab(bool slab) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = radians(45.0), .azimuth_rad = radians(90.0)};
  scene.sun->shadows = scene::SunShadows{.full_resolution = true};
  add_box(scene, {60.0, 1.0, 60.0}, {0.0, -0.5, 0.0});
  if (slab) add_box(scene, {4.0, 0.1, 4.0}, {3.0, 2.0, 0.0});
  scene::Camera camera;
  camera.name = "eye";
  camera.width = 320;
  camera.height = 32;
  camera.vertical_fov_rad = 2.0 * std::atan(0.08);
  camera.exposure.fixed_ev = 15.0;
  camera.mount.pose = {Vec3(-4.0, 10.0, 0.0), glm::angleAxis(-kPi / 2, Vec3(1.0, 0.0, 0.0))};
  scene.cameras.push_back(camera);
  return scene;
}

Result<FrameResult> render_one(gpu::Device& device, scene::Scene scene, std::string* plan) {
  NERITIC_TRY(const auto session, Session::create(device, std::move(scene)));
  session->keep_plan_dump(true);
  FrameRequest request;
  request.cameras = {0};
  NERITIC_TRY(FrameResult result, session->render(request));
  if (plan) *plan = session->plan_text();
  return result;
}

TEST_F(Light, ShadowsEdgeLiesWhereGeometryPutsIt) {
  NERITIC_ASSERT_OK(const auto result, render_one(device(), floor_and_slab(true), nullptr));
  const auto& eye = result.cameras[0].eyes[0];
  // The slab's western edge at x = 1 and its upper side at 2.05 m: sunlight from the east leads it
  // 2.05 m westwards, its lower edge 1.95. The shadow's western end is the upper edge's.
  const auto level = [&](double x_m) {
    const double metres_a_pixel = 10.0 * 0.16 / 32.0;
    return int(
        eye.color.at(static_cast<std::uint32_t>(160.0 + (x_m + 4.0) / metres_a_pixel), 16, 1));
  };
  const double edge_m = 1.0 - 2.05;
  EXPECT_GT(level(edge_m - 0.35), level(edge_m + 0.35) + 60);
  EXPECT_NEAR(level(edge_m - 0.35), level(edge_m - 3.0), 3);
  const int half = (level(edge_m - 0.35) + level(edge_m + 0.35)) / 2;
  EXPECT_GT(level(edge_m - 0.12), half);
  EXPECT_LT(level(edge_m + 0.17), half);
}

TEST_F(Light, FlatGroundHidesNothingFromItself) {
  scene::Scene scene = floor_and_slab(false);
  scene.ambient = scene::Ambient{.occlusion_m = 1.0};
  NERITIC_ASSERT_OK(const auto with, render_one(device(), std::move(scene), nullptr));
  scene = floor_and_slab(false);
  scene.sun->shadows.reset();
  scene.ambient = scene::Ambient{};
  NERITIC_ASSERT_OK(const auto without, render_one(device(), std::move(scene), nullptr));
  for (std::uint32_t x = 0; x < 320; x += 7)
    EXPECT_NEAR(int(with.cameras[0].eyes[0].color.at(x, 16, 1)),
                int(without.cameras[0].eyes[0].color.at(x, 16, 1)), 1)
        << x;
}

// A sphere under an even sky, over a bottom of this colour; linear light of the picture's middle
// column.
std::vector<double> sphere_under_an_even_sky(gpu::Device& device, float metallic, float roughness,
                                             float bottom) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = radians(90.0), .overcast = 1.0};
  scene.ambient = scene::Ambient{.bottom_color = Vec3f(bottom)};
  scene.water = scene::Water{.type = "I", .scattering = false};
  scene::Model sphere = scene::make_sphere(0.5, 96);
  scene::Material paint;
  paint.metallic = metallic;
  paint.roughness = roughness;
  paint.base_color = Vec4f(1.0f);
  sphere.materials = {paint};
  sphere.meshes[0].primitives[0].material = 0;
  scene.models.push_back(std::make_shared<scene::Model>(std::move(sphere)));
  scene::Object object;
  object.name = "sphere";
  object.model = 0;
  object.class_id = object.instance = 1;
  object.mount.pose.position_m = {0.0, -5.0, -3.0};
  scene.objects.push_back(object);
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = 64;
  camera.vertical_fov_rad = radians(20.0);
  camera.exposure.fixed_ev = 10.0;
  camera.terms.linear = true;
  camera.mount.pose.position_m = {0.0, -5.0, 0.0};
  scene.cameras.push_back(camera);
  const auto result = render_one(device, std::move(scene), nullptr);
  EXPECT_TRUE(result.ok());
  std::vector<double> column;
  if (!result.ok()) return column;
  for (std::uint32_t y = 0; y < 64; ++y)
    column.push_back(result->cameras[0].eyes[0].linear.at(32, y, 1));
  return column;
}

// White things in even light have its radiance, whatever they are of.
TEST_F(Light, AnEvenFurnaceStaysEven) {
  const std::vector<double> diffuse = sphere_under_an_even_sky(device(), 0.0f, 1.0f, 1.0f);
  ASSERT_EQ(diffuse.size(), 64u);
  ASSERT_GT(diffuse[32], 1.0);
  for (const float roughness : {0.0f, 0.2f, 0.5f, 1.0f}) {
    const std::vector<double> metal = sphere_under_an_even_sky(device(), 1.0f, roughness, 1.0f);
    ASSERT_EQ(metal.size(), 64u);
    for (std::size_t y = 5; y < 60; y += 6)
      EXPECT_NEAR(metal[y] / diffuse[y], 1.0, 0.03) << roughness << ' ' << y;
  }
}

// Where a sphere's normal is tilted by 45 degrees it mirrors the zenith, or the dark bottom; if
// rough, what lies about the normal.
TEST_F(Light, SmoothMetalMirrorsWhatIsAboveAndBelow) {
  const std::vector<double> smooth = sphere_under_an_even_sky(device(), 1.0f, 0.0f, 0.0f);
  const std::vector<double> rough = sphere_under_an_even_sky(device(), 1.0f, 1.0f, 0.0f);
  ASSERT_EQ(smooth.size() + rough.size(), 128u);
  // Seen from 3 m the sphere's outline is 30 pixels from the middle, that of such a normal
  // about 22.
  EXPECT_GT(smooth[10], 1.05 * rough[10]);
  EXPECT_LT(smooth[53], 0.5 * rough[53]);
  EXPECT_NEAR(smooth[31] + smooth[32], rough[31] + rough[32], 0.05 * (rough[31] + rough[32]));
}

TEST_F(Light, WhatIsNotNamedIsNotInTheGraph) {
  scene::Scene scene = floor_and_slab(true);
  std::string plan;
  NERITIC_ASSERT_OK(const auto with, render_one(device(), scene, &plan));
  EXPECT_NE(plan.find("sun shadows"), std::string::npos);
  scene.sun->shadows.reset();
  NERITIC_ASSERT_OK(const auto without, render_one(device(), scene, &plan));
  for (const char* pass : {"shadows", "visibility", "caustics", "shafts", "skylight"})
    EXPECT_EQ(plan.find(pass), std::string::npos) << pass;
}

// A hold of 6 x 4 x 6 m at 10 m, without a way in where `closed`, without its deck otherwise, seen
// from within; exposed for the water outside.
scene::Scene hold(bool closed) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = radians(60.0)};
  scene.sun->shadows = scene::SunShadows{};
  scene.sun->shafts = scene::Shafts{};
  scene.ambient = scene::Ambient{.bottom_depth_m = 14.0};
  scene.ambient->skylight = scene::Skylight{.low_m = {-9, -15, -9}, .high_m = {9, -5, 9}};
  scene.water = scene::Water{.type = "IB", .scattering = true};
  add_box(scene, {6.0, 0.2, 6.0}, {0.0, -13.0, 0.0});
  add_box(scene, {0.2, 4.0, 6.0}, {-3.0, -11.0, 0.0});
  add_box(scene, {0.2, 4.0, 6.0}, {3.0, -11.0, 0.0});
  add_box(scene, {6.0, 4.0, 0.2}, {0.0, -11.0, -3.0});
  add_box(scene, {6.0, 4.0, 0.2}, {0.0, -11.0, 3.0});
  if (closed) add_box(scene, {6.2, 0.2, 6.2}, {0.0, -9.0, 0.0});
  scene::Camera camera;
  camera.name = "eye";
  camera.width = 64;
  camera.height = 48;
  camera.exposure.fixed_ev = 12.0;
  camera.mount.pose.position_m = {0.0, -11.0, 2.0};
  scene.cameras.push_back(camera);
  return scene;
}

double mean_green(const FrameResult& result) {
  double sum = 0.0;
  for (std::uint32_t y = 0; y < 48; ++y)
    for (std::uint32_t x = 0; x < 64; ++x) sum += result.cameras[0].eyes[0].color.at(x, y, 1);
  return sum / (64 * 48);
}

TEST_F(Light, AClosedHoldIsDarkAndAnOpenOneIsNot) {
  NERITIC_ASSERT_OK(const auto closed, render_one(device(), hold(true), nullptr));
  NERITIC_ASSERT_OK(const auto open, render_one(device(), hold(false), nullptr));
  scene::Scene without = hold(true);
  without.ambient->skylight.reset();
  NERITIC_ASSERT_OK(const auto shines, render_one(device(), std::move(without), nullptr));
  EXPECT_LT(mean_green(closed), 0.15 * mean_green(shines));
  EXPECT_LT(mean_green(closed), 0.15 * mean_green(open));
  EXPECT_GT(mean_green(open), 20.0);
}

TEST_F(Light, SkylightLeavesOpenWaterAsItIs) {
  scene::Scene scene = hold(true);
  scene.objects.clear();
  NERITIC_ASSERT_OK(const auto with, render_one(device(), scene, nullptr));
  scene.ambient->skylight.reset();
  NERITIC_ASSERT_OK(const auto without, render_one(device(), std::move(scene), nullptr));
  for (std::uint32_t x = 0; x < 64; x += 3)
    for (std::uint32_t y = 0; y < 48; y += 5)
      EXPECT_NEAR(int(with.cameras[0].eyes[0].color.at(x, y, 1)),
                  int(without.cameras[0].eyes[0].color.at(x, y, 1)), 1);
}

// A thin upright sheet in air with the sun behind it, low: of its light the eye gets what the sheet
// lets through, the share t of albedo / pi; a sheet of none is lit by the sky alone.
TEST_F(Light, AThinSheetShinesWithTheSunBehindIt) {
  const auto level = [&](float through, bool shadows = false) {
    scene::Scene scene;
    scene.path = "test";
    scene.sun = scene::Sun{.elevation_rad = radians(20.0)};  // in the north: behind the sheet
    if (shadows) scene.sun->shadows = scene::SunShadows{};
    add_box(scene, {4.0, 4.0, 0.002}, {0.0, 0.0, -3.0});
    scene::Model model = *scene.models[0];
    model.materials[0].diffuse_transmission = through;
    scene.models[0] = std::make_shared<scene::Model>(model);
    scene::Camera camera;
    camera.name = "eye";
    camera.width = 32;
    camera.height = 32;
    camera.exposure.fixed_ev = 14.0;
    scene.cameras.push_back(camera);
    auto result = render_one(device(), std::move(scene), nullptr);
    EXPECT_TRUE(result.ok());
    return int(result->cameras[0].eyes[0].color.at(16, 16, 1));
  };
  const int none = level(0.0f), half = level(0.5f), all = level(1.0f);
  EXPECT_GT(half, none + 30);
  EXPECT_GT(all, half + 15);
  EXPECT_NEAR(level(1.0f, true), all, 3) << "the sheet throws no shadow on itself";
}

// Light on the levels below a tile.
std::vector<float> thrown(gpu::Device& device, const shared::CausticsParams& params) {
  auto renderer = render::Renderer::create(device);
  auto frames = gpu::Frames::create(device);
  EXPECT_TRUE(renderer.ok() && frames.ok());
  graph::Executor executor(**frames);
  graph::FrameGraph graph;
  auto image = (*renderer)->declare_caustics(graph, params);
  EXPECT_TRUE(image.ok());
  ReadbackPool pool;
  const std::uint32_t n = params.texels;
  auto pin = pool.declare(graph, device, "caustics", *image, render::kHdrFormat, n, n,
                          shared::kCausticLayers);
  EXPECT_TRUE(pin.ok());
  auto commands = (*frames)->begin();
  EXPECT_TRUE(commands.ok());
  EXPECT_TRUE(executor.run(graph, **commands).ok());
  auto done = (*frames)->submit();
  EXPECT_TRUE(done.ok() && (*frames)->wait(*done).ok());
  std::vector<float> out;
  for (const std::uint16_t half : (*pin)->mapped<std::uint16_t>())
    out.push_back(glm::unpackHalf1x16(half));
  device.wait_idle();
  return out;
}

double mean_of_level(const std::vector<float>& light, std::uint32_t n, std::uint32_t level) {
  double sum = 0.0;
  for (std::size_t i = 0; i < std::size_t{n} * n; ++i)
    sum += light[(std::size_t{level / shared::kCausticLayerStep} * n * n + i) * 4 +
                 level % shared::kCausticLayerStep];
  return sum / (double(n) * n);
}

TEST_F(Light, FlatWaterThrowsNoNetAndWavesKeepTheMean) {
  scene::Caustics caustics{.tile_m = 4.0, .texels = 96};
  shared::CausticsParams params =
      render::caustics_params(caustics, glm::normalize(Vec3(0.4, 1.0, 0.2)), 3.0, 7);
  const std::vector<float> waves = thrown(device(), params);
  for (std::uint32_t level = 0; level < shared::kCausticLevels; ++level)
    EXPECT_NEAR(mean_of_level(waves, 96, level), 1.0, 0.01) << level;
  float most = 0.0f;
  for (const float light : waves) most = std::max(most, light);
  EXPECT_GT(most, 2.0f);
  params.count = 0;
  for (const float light : thrown(device(), params)) ASSERT_EQ(light, 1.0f);
}

TEST_F(Light, ASineWavesFirstFocusLiesWhereTheFormulaSays) {
  // Paraxial optics: on the axis of a crest the light at depth d is 1 / (1 - d / f), f = n / ((n -
  // 1) A k^2) = 2.028 m for 5 cm and 1 m. Read well above the focus, where the texels resolve it.
  const scene::Caustics caustics{
      .waves = {{0.05, 1.0, radians(90.0)}}, .tile_m = 2.0, .texels = 256};
  shared::CausticsParams params = render::caustics_params(caustics, Vec3(0.0, 1.0, 0.0), 0.0, 1);
  params.first_m = 1.0f;
  params.step = 1.0f;
  const std::vector<float> light = thrown(device(), params);
  double crest = 0.0;
  for (std::uint32_t x = 0; x < 256; ++x) crest = std::max(crest, double(light[x * 4]));
  EXPECT_NEAR(1.0 / (1.0 - 1.0 / crest), 2.028, 0.04);
}

// A depth between two levels has a blend of theirs: the brightest level is where a floor would be.
TEST_F(Light, TheBrightestDepthUnderASineWaveIsItsFirstFocus) {
  const scene::Caustics caustics{
      .waves = {{0.05, 1.0, radians(90.0)}}, .tile_m = 2.0, .texels = 512};
  const shared::CausticsParams params =
      render::caustics_params(caustics, Vec3(0.0, 1.0, 0.0), 0.0, 1);
  const std::vector<float> light = thrown(device(), params);
  double most = 0.0, at_m = 0.0;
  for (std::uint32_t level = 0; level < shared::kCausticLevels; ++level)
    for (std::uint32_t x = 0; x < 512; ++x) {
      const double here =
          light[(std::size_t{level / shared::kCausticLayerStep} * 512 * 512 + x) * 4 +
                level % shared::kCausticLayerStep];
      if (here > most) most = here, at_m = params.first_m * std::pow(params.step, level);
    }
  EXPECT_NEAR(at_m, 2.028, 0.05);
}

// Open water under a sun in the zenith, seen level from 3 m deep.
scene::Scene open_water(double fov_deg) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = radians(90.0)};
  scene.water = scene::Water{.type = "IB", .scattering = true};
  scene::Camera camera;
  camera.name = "eye";
  camera.width = 160;
  camera.height = 96;
  camera.vertical_fov_rad = radians(fov_deg);
  camera.exposure.fixed_ev = 13.0;
  camera.terms.linear = true;
  camera.mount.pose.position_m = {0.0, -3.0, 0.0};
  scene.cameras.push_back(camera);
  return scene;
}

TEST_F(Light, ASightThroughAShadowLosesWhatItsWaterWouldScatter) {
  // A slab between 4 and 6 m ahead, 2 m over the sight.
  const auto with = [&](bool shafts) {
    scene::Scene scene = open_water(8.0);
    scene.sun->shadows = scene::SunShadows{.cascades = 1, .reach_m = 20.0};
    if (shafts) scene.sun->shafts = scene::Shafts{.samples = 64};
    add_box(scene, {30.0, 0.1, 2.0}, {0.0, -1.0, -5.0});
    auto result = render_one(device(), std::move(scene), nullptr);
    EXPECT_TRUE(result.ok());
    return double(result->cameras[0].eyes[0].linear.at(80, 48, 1));
  };
  const scene::Scene scene = open_water(8.0);
  render::FrameState state;
  NERITIC_ASSERT_OK(
      const shared::Lighting light,
      render::make_lighting(scene, state, Vec3(0.0, -3.0, 0.0), scene.cameras[0].exposure, false));
  // The shares of the beam and of the light round it that a level sight is sent
  // (shaders/shared/water.glsl).
  const double particles = light.particle_scattering.y, water = light.water_scattering.y;
  const double direct =
      light.direct_share * std::exp(-3.0 * (particles * (1.0 - shared::kParticleG) + water));
  const double beam = direct * (particles * shared::henyey_greenstein(0.0f, shared::kParticleG) +
                                water * shared::sea_water_phase(0.0f));
  const double round = (1.0 - direct) / 0.8 *
                       (particles * shared::henyey_greenstein(0.0f, shared::kDiffuseG) +
                        water * shared::sea_water_phase(0.0f));
  const double core = std::exp(-shared::kOutOfCore * 3.0 * particles);
  const double c = light.beam_attenuation.y;
  const double lost = beam / (beam + round) * core * (std::exp(-4.0 * c) - std::exp(-6.0 * c));
  ASSERT_GT(lost, 0.01);
  EXPECT_NEAR(1.0 - with(true) / with(false), lost, 0.06 * lost);
}

TEST_F(Light, ShaftsOfWavesKeepTheMeanAndFlatWaterHasNone) {
  const auto picture = [&](bool shafts, double wind_m_s) {
    scene::Scene scene = open_water(70.0);
    scene.sun->caustics = scene::Caustics{.wind_m_s = wind_m_s};
    // Without wind there are still ripples (Cox and Munk 1954): flat is a wave of no height.
    if (!(wind_m_s > 0.0)) scene.sun->caustics->waves = {{0.0, 1.0, 0.0}};
    if (shafts) scene.sun->shafts = scene::Shafts{};
    auto result = render_one(device(), std::move(scene), nullptr);
    EXPECT_TRUE(result.ok());
    std::vector<double> green;
    const ImageF32& linear = result->cameras[0].eyes[0].linear;
    for (std::uint32_t y = 0; y < linear.height; ++y)
      for (std::uint32_t x = 0; x < linear.width; ++x) green.push_back(linear.at(x, y, 1));
    return green;
  };
  const auto even = picture(false, 4.0), waves = picture(true, 4.0), flat = picture(true, 0.0);
  double sum = 0.0, expected = 0.0, most = 0.0;
  for (std::size_t i = 0; i < even.size(); ++i) {
    sum += waves[i];
    expected += even[i];
    most = std::max(most, std::abs(waves[i] / even[i] - 1.0));
    EXPECT_NEAR(flat[i], even[i], 1e-3 * even[i]);
  }
  EXPECT_NEAR(sum / expected, 1.0, 0.01);
  EXPECT_GT(most, 0.02);
}

TEST(SunPosition, NoonAtTheTropicOnMidsummerIsInTheZenithAndEveningInTheWest) {
  const auto noon = scene::sun_position(radians(23.45), 172, 12.0);
  EXPECT_GT(noon.elevation_rad, radians(89.5));
  // Equinox at 50 degrees north: noon at 40 degrees in the south, six o'clock on the horizon in the
  // west.
  const auto spring = scene::sun_position(radians(50.0), 81, 12.0);
  EXPECT_NEAR(spring.elevation_rad, radians(40.0), radians(0.5));
  EXPECT_NEAR(std::abs(spring.azimuth_rad), kPi, 1e-6);
  const auto evening = scene::sun_position(radians(50.0), 81, 18.0);
  EXPECT_NEAR(evening.elevation_rad, 0.0, radians(0.5));
  EXPECT_NEAR(evening.azimuth_rad, -kPi / 2, radians(1.0));
}

}  // namespace
}  // namespace neritic::testbed
