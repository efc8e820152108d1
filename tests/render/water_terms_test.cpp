// The water's terms: forward scatter against Wells's formula as the passes leave it, snow's density
// and its rest in the water, bubbles' rise and growth, the shaders' waves against those in double.
#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/packing.hpp>
#include <set>

#include "engine/gpu/frames.hpp"
#include "engine/render/bubble_field.hpp"
#include "engine/render/particles.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/sea_waves.hpp"
#include "engine/render/snow_field.hpp"
#include "shared/bubble.h"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::render {
namespace {

using ForwardScatterGpu = test::GpuTest;

constexpr std::uint32_t kWidth = 2048, kHeight = 64;
constexpr double kPixelsRad = 692.0;  // of 1280x720 at 55 degrees

// Type II in the green: b of particles 0.357, c 0.42.
shared::Lighting type_ii() {
  shared::Lighting light{};
  light.terms = shared::kLightWater | shared::kLightForwardScatter;
  light.particle_scattering = Vec3f(0.357f);
  light.beam_attenuation = Vec3f(0.42f);
  return light;
}

gpu::Image picture_of(gpu::Device& device, const char* name,
                      const std::function<Vec4(int)>& column) {
  auto image =
      gpu::Image::create(device, {name, kHdrFormat, kWidth, kHeight, 1, 1,
                                  VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                      VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                  true});
  EXPECT_TRUE(image.ok());
  std::vector<std::uint16_t> texels;
  for (std::uint32_t y = 0; y < kHeight; ++y)
    for (std::uint32_t x = 0; x < kWidth; ++x)
      for (int i = 0; i < 4; ++i)
        texels.push_back(glm::packHalf1x16(static_cast<float>(column(static_cast<int>(x))[i])));
  EXPECT_TRUE(gpu::upload_image(device, *image, std::as_bytes(std::span(texels))).ok());
  return std::move(*image);
}

// Contrast that is left of stripes of psi cycles a radian at a distance.
double contrast_left(gpu::Device& device, double psi, double distance_m, std::uint32_t levels) {
  const shared::Lighting light = type_ii();
  const auto stripes = [&](int x) {
    return std::cos(2.0 * kPi * psi * (x + 0.5 - kWidth / 2) / kPixelsRad);
  };
  // As shading leaves them: the picture by c; what scatters forwards by c - b. Brighter, to use
  // halves well.
  const double scale = 100.0 * std::exp(0.063 * distance_m);
  const double sharp = scale * std::exp(-0.42 * distance_m),
               kept = scale * std::exp(-0.063 * distance_m);
  gpu::Image hdr = picture_of(device, "picture",
                              [&](int x) { return Vec4(Vec3(sharp * stripes(x) + 300.0), 1.0); });
  gpu::Image scattered = picture_of(
      device, "scattered", [&](int x) { return Vec4(Vec3(kept * stripes(x)), distance_m); });
  WaterPasses passes(device);
  ViewSet views;
  views.width = kWidth;
  views.height = kHeight;
  views.views.resize(1);
  const double top = 0.5 * kHeight / kPixelsRad, right = 0.5 * kWidth / kPixelsRad;
  views.views[0].tangents = {-right, right, -top, top};
  GBuffer gbuffer;
  gbuffer.width = kWidth;
  gbuffer.height = kHeight;
  auto frames = gpu::Frames::create(device);
  EXPECT_TRUE(frames.ok());
  graph::Executor executor(**frames);
  graph::FrameGraph graph;
  const graph::ImportState state{.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const auto out = passes.declare_forward_scatter(
      graph, "", graph.import_image(hdr, state), graph.import_image(scattered, state), gbuffer,
      views, light, {.angle_rad = 0.03, .levels = levels});
  EXPECT_TRUE(out.ok());
  graph.output(*out, graph::Access::kTransferRead);
  const auto commands = (*frames)->begin();
  EXPECT_TRUE(executor.run(graph, **commands).ok());
  EXPECT_TRUE((*frames)->wait((*frames)->submit().value()).ok());
  const auto bytes = gpu::read_image(device, hdr, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  EXPECT_TRUE(bytes.ok());
  const auto* halves = reinterpret_cast<const std::uint16_t*>(bytes->data());
  // Over whole periods about the middle, where the picture's ends do not reach.
  const double period = kPixelsRad / psi;
  const int half = static_cast<int>(std::max(1.0, std::floor(384.0 / period)) * period);
  double sum = 0.0, norm = 0.0;
  for (int x = static_cast<int>(kWidth) / 2 - half; x < static_cast<int>(kWidth) / 2 + half; ++x) {
    const double green = glm::unpackHalf1x16(halves[4 * (kHeight / 2 * kWidth + x) + 1]);
    sum += (green - 300.0) * stripes(x);
    norm += stripes(x) * stripes(x);
  }
  return sum / norm / scale;
}

double wells(double psi, double distance_m) {
  const double x = 2.0 * kPi * 0.03 * psi;
  return std::exp(-(0.42 - 0.357 * (1.0 - std::exp(-x)) / x) * distance_m);
}

TEST_F(ForwardScatterGpu, ContrastAtFiveAndTwentyMetresIsWellss) {
  for (const double distance_m : {5.0, 20.0})
    for (const double psi : {2.0, 5.0, 12.0, 40.0}) {
      const double left = contrast_left(device(), psi, distance_m, 7);
      RecordProperty(fmt::format("psi_{}_at_{}_m", psi, distance_m), fmt::format("{:.4f}", left));
      EXPECT_NEAR(left, wells(psi, distance_m), 0.05)
          << psi << " cycles/rad, " << distance_m << " m";
    }
}

TEST(ForwardScatter, OctavesFollowFromFineToCoarseAndEndInAllThatIsLeft) {
  const auto levels = scatter_levels({}, type_ii(), 1280, 720, kPixelsRad);
  ASSERT_EQ(levels.size(), scene::ForwardScatter{}.levels);
  EXPECT_EQ(levels.front().width, 320u);
  EXPECT_EQ(levels.front().push.high_cycles_rad, 0.0f);
  EXPECT_EQ(levels.back().push.low_cycles_rad, 0.0f);
  for (std::size_t i = 1; i < levels.size(); ++i)
    EXPECT_FLOAT_EQ(levels[i].push.high_cycles_rad, levels[i - 1].push.low_cycles_rad);
  // A picture without room for them has fewer.
  EXPECT_EQ(scatter_levels({.levels = 8}, type_ii(), 3, 3, kPixelsRad).size(), 1u);
}

TEST(Snow, HasTheDensityThatIsNamed) {
  for (const double density : {30.0, 400.0, 3000.0}) {
    const scene::Snow snow{.density_m3 = density, .range_m = 2.0};
    double count = 0.0;
    constexpr int kPlaces = 8;
    for (int i = 0; i < kPlaces; ++i)
      count += static_cast<double>(snow_around(snow, 5, Vec3(17.0 * i, -30.0, 3.0), 0.0).size());
    const double wanted = density * 4.0 / 3.0 * kPi * 8.0 * kPlaces;
    EXPECT_NEAR(count, wanted, 4.0 * std::sqrt(wanted)) << density;
  }
}

TEST(Snow, StaysInTheWaterWhileTheCameraMoves) {
  const scene::Snow snow{.range_m = 1.0};
  const auto first = snow_around(snow, 5, Vec3(0.0, -10.0, 0.0), 0.0);
  const auto second = snow_around(snow, 5, Vec3(0.13, -10.03, 0.06), 0.0);
  std::size_t same = 0;
  for (const WorldParticle& a : first)
    for (const WorldParticle& b : second)
      if (a.seed == b.seed && glm::length(a.position_m - b.position_m) < 1e-9) ++same;
  // The two spheres of 1 m share nine tenths.
  EXPECT_GT(same, first.size() * 8 / 10);
  // And drifts with it.
  scene::Snow drifting = snow;
  drifting.drift_m_s = Vec3(0.1, 0.0, 0.0);
  const auto before = snow_around(drifting, 5, Vec3(0.0, -10.0, 0.0), 0.0);
  const auto after = snow_around(drifting, 5, Vec3(0.2, -10.0, 0.0), 2.0);
  ASSERT_EQ(before.size(), after.size());
  EXPECT_NEAR(after[0].position_m.x - before[0].position_m.x, 0.2, 1e-9);
}

TEST(Snow, KeptCellsGiveTheGrainsOfCellsThatAreMadeAnew) {
  scene::Snow snow{.density_m3 = 200.0, .range_m = 1.5};
  SnowField field;
  const auto check = [&](const Vec3& center_m, double time_s, std::uint64_t seed) {
    std::vector<WorldParticle> kept;
    field.append(snow, seed, center_m, time_s, 0.8, kept);
    const auto made = snow_around(snow, seed, center_m, time_s, 0.8);
    ASSERT_EQ(kept.size(), made.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      EXPECT_EQ(kept[i].position_m, made[i].position_m);
      EXPECT_EQ(kept[i].radius_m, made[i].radius_m);
      EXPECT_EQ(kept[i].opacity, made[i].opacity);
      EXPECT_EQ(kept[i].seed, made[i].seed);
    }
  };
  for (int i = 0; i < 300; ++i) check(Vec3(0.2 * i, -20.0 + 0.01 * i, -0.1 * i), 0.05 * i, 5);
  // Cells that lie behind are forgotten.
  EXPECT_LT(field.cells(), 20000u);
  check(Vec3(0.0, -20.0, 0.0), 0.0, 6);
  snow.density_m3 = 900.0;
  check(Vec3(0.0, -20.0, 0.0), 0.0, 6);
}

// A view set gets all grains in its sight, whether their cell is wholly in sight or not, cell by
// cell from far to near.
TEST(Snow, AViewGetsTheGrainsInItsSight) {
  scene::Scene scene;
  scene.water.emplace();
  scene.water->snow = scene::Snow{.density_m3 = 300.0, .range_m = 2.5};
  const scene::MotionSource motion(scene);
  ViewDesc view;
  view.world_from_view = {Vec3(3.0, -9.0, 1.0), from_yaw_pitch_roll(0.3, -0.2, 0.1)};
  const ViewSet views{.width = 600, .height = 600, .views = {view}};
  SnowField snow;
  BubbleField bubbles;
  const ViewParticles seen = view_particles(motion, snow, bubbles, 7, views, 2.0);
  const Vec3 origin = views.origin_m();
  std::size_t expected = 0;
  std::set<std::uint32_t> looks;
  for (const shared::Particle& particle : seen.particles) looks.insert(particle.seed);
  for (const WorldParticle& grain : snow_around(*scene.water->snow, 7, origin, 2.0)) {
    const double pixels = 600.0 / (view.tangents.right - view.tangents.left);
    const double own = grain.radius_m * pixels / glm::distance(grain.position_m, origin);
    const bool faint = 2.0 * own * own / (own * own + 0.56) * grain.opacity < 0.003;
    if (faint || !any_view_sees(views, grain.position_m - origin, grain.radius_m + kSpotRoom_m))
      continue;
    ++expected;
    EXPECT_TRUE(looks.contains(grain.seed));
  }
  EXPECT_GT(expected, 500u);
  EXPECT_EQ(seen.particles.size(), expected);
  EXPECT_GT(glm::length(Vec3(seen.particles.front().position)),
            glm::length(Vec3(seen.particles.back().position)));
}

// A field goes on from the cells that it found before, whichever view that was for.
TEST(Snow, AFieldOfManyViewsPlacesWhatANewOneDoes) {
  scene::Scene scene;
  scene.water.emplace();
  scene.water->snow = scene::Snow{.density_m3 = 300.0, .range_m = 2.0};
  const scene::MotionSource motion(scene);
  SnowField kept;
  BubbleField bubbles;
  for (int i = 0; i < 200; ++i) {
    ViewDesc view;
    // One swims and looks around, another lies near it, a third far off.
    const Vec3 from_m = i % 3 == 0   ? Vec3(0.05 * i, -9.0, -0.02 * i)
                        : i % 3 == 1 ? Vec3(1.0, -9.5, 0.5)
                                     : Vec3(300.0, -2.0, 4.0);
    view.world_from_view = {from_m, from_yaw_pitch_roll(0.05 * i, -0.2, 0.01 * i)};
    const ViewSet views{.width = 600, .height = 600, .views = {view}};
    const std::uint64_t seed = i < 150 ? 7 : 8;
    const auto seen = view_particles(motion, kept, bubbles, seed, views, 0.1 * i).particles;
    SnowField anew;
    const auto made = view_particles(motion, anew, bubbles, seed, views, 0.1 * i).particles;
    ASSERT_EQ(seen.size(), made.size());
    ASSERT_GT(seen.size(), 100u);
    EXPECT_EQ(std::memcmp(seen.data(), made.data(), seen.size() * sizeof seen[0]), 0) << i;
  }
}

// A quarter at least stays; what stays has the light of all, and is the same whatever the time.
TEST(Snow, SmallSpotsAreThinnedOutAndKeepTheirLight) {
  scene::Scene scene;
  scene.water.emplace();
  scene.water->snow = scene::Snow{.density_m3 = 3000.0, .range_m = 2.5};
  const scene::MotionSource motion(scene);
  ViewDesc view;
  view.world_from_view.position_m = Vec3(3.0, -9.0, 1.0);
  view.tangents = {-1.0, 1.0, -1.0, 1.0};
  const ViewSet views{.width = 200, .height = 200, .views = {view}};
  SnowField field;
  BubbleField bubbles;
  const auto seen = [&](double spot_px) {
    return view_particles(motion, field, bubbles, 7, views, 2.0, 1.0, spot_px).particles;
  };
  const auto light = [](const std::vector<shared::Particle>& particles) {
    double sum = 0.0;
    for (const shared::Particle& p : particles)
      sum += p.opacity * p.radius_m * p.radius_m / glm::dot(p.position, p.position);
    return sum;
  };
  const auto all = seen(0.0), some = seen(0.5), least = seen(1e9);
  EXPECT_LT(some.size(), all.size());
  EXPECT_LT(least.size(), some.size() + 1);
  EXPECT_NEAR(double(least.size()), 0.25 * double(all.size()), 0.03 * double(all.size()));
  EXPECT_NEAR(light(some), light(all), 0.1 * light(all));
  EXPECT_NEAR(light(least), light(all), 0.2 * light(all));
  std::set<std::uint32_t> looks;
  for (const shared::Particle& p : some) looks.insert(p.seed);
  for (const shared::Particle& p : least) EXPECT_TRUE(looks.contains(p.seed));
}

TEST(Snow, IsFiniteFarOutAndNoneIsAboveTheWater) {
  for (const double x : {0.0, 1e7, -4e7})
    for (const double y : {0.0, -0.01, -1000.0, 100.0})
      for (const WorldParticle& particle : snow_around({.range_m = 1.0}, 5, Vec3(x, y, -x), 1e5)) {
        EXPECT_TRUE(std::isfinite(glm::length(particle.position_m)));
        EXPECT_LT(particle.position_m.y, 0.0);
        EXPECT_LE(glm::distance(particle.position_m, Vec3(x, y, -x)), 1.001);
      }
}

scene::Scene with_object_at(const Vec3& place_m) {
  scene::Scene scene;
  scene.objects.resize(1);
  scene.objects[0].mount.pose.position_m = place_m;
  return scene;
}

TEST(Bubbles, RiseAsMendelsonSays) {
  // For 1 cm and 4 cm in diameter; in contaminated water of small ones Clift, Grace and Weber 1978,
  // fig. 7.3.
  EXPECT_NEAR(bubble_speed_m_s(0.005), 0.252, 0.003);
  EXPECT_NEAR(bubble_speed_m_s(0.020), 0.447, 0.003);
  EXPECT_LT(bubble_speed_m_s(0.0005), 0.35);
}

TEST(Bubbles, GrowRiseAndEndAtTheSurfaceTheSameEachTime) {
  const scene::Scene scene = with_object_at(Vec3(1.0, -6.0, 2.0));
  const scene::MotionSource motion(scene);
  scene::BubbleSource source;
  source.object = 0;
  source.height_m = 20.0;
  std::vector<WorldParticle> at, again;
  BubbleField field;
  field.append(motion, source, 0, 9, 33.0, at);
  field.append(motion, source, 0, 9, 33.0, again);
  ASSERT_GT(at.size(), 100u);
  ASSERT_EQ(at.size(), again.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_EQ(at[i].position_m, again[i].position_m);
    EXPECT_LT(at[i].position_m.y, 0.0);
    EXPECT_GE(at[i].position_m.y, -6.1);
  }
  // Two moments later the same bubble is higher and larger, by Boyle.
  std::vector<WorldParticle> later;
  field.append(motion, source, 0, 9, 33.5, later);
  int followed = 0;
  for (const WorldParticle& a : at)
    for (const WorldParticle& b : later)
      if (a.seed == b.seed) {
        ++followed;
        EXPECT_GT(b.position_m.y, a.position_m.y);
        const double pressures = (10.07 - a.position_m.y) / (10.07 - b.position_m.y);
        EXPECT_NEAR(b.radius_m / a.radius_m, std::cbrt(pressures), 1e-3);
      }
  EXPECT_GT(followed, 50);
}

TEST(Bubbles, AreTheSameWhetherTheirBreathsAreKept) {
  const scene::Scene scene = with_object_at(Vec3(1.0, -30.0, 2.0));
  const scene::MotionSource motion(scene);
  scene::BubbleSource source;
  source.object = 0;
  BubbleField kept;
  for (const double time_s : {100.0, 100.1, 117.0, 60.0, 4e5}) {
    std::vector<WorldParticle> by_kept, anew;
    kept.append(motion, source, 0, 9, time_s, by_kept);
    BubbleField().append(motion, source, 0, 9, time_s, anew);
    ASSERT_GT(anew.size(), 100u);
    ASSERT_EQ(by_kept.size(), anew.size());
    for (std::size_t i = 0; i < anew.size(); ++i)
      EXPECT_EQ(by_kept[i].position_m, anew[i].position_m);
  }
  // Other settings, another seed.
  source.flow_m3_s *= 0.5;
  std::vector<WorldParticle> fewer, anew;
  kept.append(motion, source, 0, 10, 4e5, fewer);
  BubbleField().append(motion, source, 0, 10, 4e5, anew);
  EXPECT_EQ(fewer.size(), anew.size());
}

TEST(Bubbles, AViewGetsThoseInItsSight) {
  const scene::Scene scene = with_object_at(Vec3(1.0, -30.0, 2.0));
  const scene::MotionSource motion(scene);
  scene::BubbleSource source;
  source.object = 0;
  source.median_radius_m = 2.5e-3;  // some break up
  std::size_t in_sight = 0, left_out = 0;
  for (int i = 0; i < 100; ++i) {
    ViewDesc view;
    view.world_from_view = {Vec3(1.0 + 0.02 * i, -30.5 + 0.1 * i, 2.0 + 0.03 * i),
                            from_yaw_pitch_roll(0.4 * i, 0.1 * i, 0.3 * i)};
    const ViewSet views{.width = 600, .height = 600, .views = {view}};
    const SphereCulling sight(views);
    std::vector<WorldParticle> all, seen;
    BubbleField().append(motion, source, 0, 9, 50.0 + i, all);
    BubbleField().append(motion, source, 0, 9, 50.0 + i, seen, &sight);
    left_out += all.size() - seen.size();
    std::set<std::pair<std::uint32_t, double>> of_seen;
    for (const WorldParticle& b : seen) of_seen.emplace(b.seed, b.position_m.y);
    for (const WorldParticle& b : all)
      if (any_view_sees(views, b.position_m - views.origin_m(), b.radius_m + kSpotRoom_m)) {
        ++in_sight;
        EXPECT_TRUE(of_seen.contains({b.seed, b.position_m.y})) << i << ' ' << b.position_m.y;
      }
  }
  EXPECT_GT(in_sight, 1000u);
  EXPECT_GT(left_out, in_sight);
}

TEST(Bubbles, CarryTheGasThatTheSourceNamesAsTheyBreakUp) {
  // So deep that they hardly grow.
  const scene::Scene scene = with_object_at(Vec3(0.0, -2e5, 0.0));
  const scene::MotionSource motion(scene);
  scene::BubbleSource source;
  source.object = 0;
  source.median_radius_m = 1.6e-3;
  source.flow_m3_s = 1e-4;
  source.height_m = 12.0;
  // What passes a height a second, as a mean over all heights.
  double flow_m3_s = 0.0, wide = 0.0, all = 0.0;
  double low_m3 = 0.0, high_m3 = 0.0, low_m4 = 0.0, high_m4 = 0.0;
  constexpr int kRuns = 60;
  std::vector<double> diameters;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<WorldParticle> bubbles;
    BubbleField().append(motion, source, 0, std::uint64_t(100 + run), 200.0 + 7.7 * run, bubbles);
    for (const WorldParticle& b : bubbles) {
      flow_m3_s += 4.0 / 3.0 * kPi * b.radius_m * b.radius_m * b.radius_m * b.velocity_m_s.y /
                   source.height_m / kRuns;
      all += 1.0;
      if (b.radius_m > 0.01) wide += 1.0;
      const double rise_m = b.position_m.y + 2e5, volume_m3 = std::pow(b.radius_m, 3);
      if (rise_m < 0.1) diameters.push_back(2.0 * b.radius_m);  // none is broken yet
      if (rise_m < 0.3) {
        low_m3 += volume_m3;
        low_m4 += volume_m3 * b.radius_m;
      } else if (rise_m > 3.0) {
        high_m3 += volume_m3;
        high_m4 += volume_m3 * b.radius_m;
      }
    }
  }
  EXPECT_NEAR(flow_m3_s, source.flow_m3_s, 0.1 * source.flow_m3_s);
  // Many sizes: half are small, few are caps, which break up on the way.
  std::ranges::nth_element(diameters, diameters.begin() + std::ptrdiff_t(diameters.size() / 2));
  EXPECT_NEAR(diameters[diameters.size() / 2], 3.2e-3, 0.6e-3);
  EXPECT_GT(wide, 10.0);
  EXPECT_LT(wide, 0.1 * all);
  EXPECT_GT(low_m4 / low_m3, 1.15 * high_m4 / high_m3);
}

TEST(Bubbles, AreCapsWhereCliftGraceAndWeberFoundThem) {
  // Eotvos numbers of 8.8, 22 and 44.
  EXPECT_EQ(shared::bubble_cap(0.004f), 0.0f);
  EXPECT_NEAR(shared::bubble_cap(0.0063f), 0.35, 0.05);
  EXPECT_EQ(shared::bubble_cap(0.009f), 1.0f);
}

TEST(Bubbles, AreAsFlatAsWellekMeasuredAndMirrorAllBeyondTheCriticalAngle) {
  // Eotvos numbers of 0.55, 3.42 and 13.7.
  EXPECT_NEAR(shared::bubble_aspect(0.001f), 0.906, 0.005);
  EXPECT_NEAR(shared::bubble_aspect(0.0025f), 0.707, 0.005);
  EXPECT_NEAR(shared::bubble_aspect(0.005f), 0.458, 0.005);
  EXPECT_EQ(shared::bubble_aspect(1.0f), 0.42f);
  EXPECT_NEAR(shared::bubble_aspect(0.0f), 1.0f, 1e-4);
  // Fresnel: ((n - 1) / (n + 1))^2 head on; all from 1 / n = sin 48.6 degrees on.
  EXPECT_NEAR(shared::bubble_reflectance(0.0f), 0.02037, 1e-4);
  EXPECT_LT(shared::bubble_reflectance(0.74f), 0.5f);
  EXPECT_EQ(shared::bubble_reflectance(0.7503f), 1.0f);
  EXPECT_EQ(shared::bubble_reflectance(1.0f), 1.0f);
}

TEST(Bubbles, TurnLightAsTwoRefractionsDo) {
  const Vec3f along(0.0f, 0.0f, -1.0f);
  for (const double sine : {0.0, 0.2, 0.5, 0.7, 0.749}) {
    const Vec3f normal(0.0f, float(sine), float(std::sqrt(1.0 - sine * sine)));
    // In at the angle i, on through the gas at asin(n sin i), out again alike.
    const double turn = 2.0 * (std::asin(1.333 * sine) - std::asin(sine));
    const Vec3f passed = shared::bubble_passed(along, normal);
    EXPECT_NEAR(passed.y, std::sin(turn), 2e-3) << sine;
    EXPECT_NEAR(passed.z, -std::cos(turn), 2e-3) << sine;
    const Vec3f mirrored = shared::bubble_mirrored(along, normal);
    EXPECT_NEAR(mirrored.y, std::sin(2.0 * (kPi / 2.0 - std::asin(sine))), 1e-5) << sine;
  }
}

// A kind after the other, for each has a pipeline of its own: small bubbles, wide ones, snow behind
// the silt, silt, snow before it.
TEST(Particles, KindsFollowOneAnotherAndSmallBubblesAreSpots) {
  scene::Scene scene;
  scene.objects.resize(1);
  scene.water.emplace();
  scene.water->snow = scene::Snow{.density_m3 = 200.0, .range_m = 3.0};
  scene.water->bubbles.emplace_back().object = 0;
  scene::SiltSource& source = scene.water->silt.emplace_back();
  source.object = 0;
  source.bed_depth_m = 10.0;
  class Goes final : public scene::SimulatedMotion {
   public:
    std::optional<scene::MotionAt> at(std::size_t, double) const override { return std::nullopt; }
    std::optional<scene::FollowedPlace> followed(std::size_t, int, const Vec3&,
                                                 double time_s) const override {
      return scene::FollowedPlace{Vec3(0.1 * time_s - 5.0, -9.7, 0.0), 0.3};
    }
  } goes;
  ViewDesc view;
  view.world_from_view.position_m = Vec3(0.0, -9.5, 2.0);
  const ViewSet views{.width = 600, .height = 600, .views = {view}};
  SnowField snow;
  BubbleField bubbles;
  const ViewParticles shown =
      view_particles(scene::MotionSource(scene, &goes), snow, bubbles, 7, views, 50.0);
  const std::vector<shared::Particle>& seen = shown.particles;
  // Also those of which nothing is in sight: their pipelines are made at once.
  EXPECT_EQ(std::set(shown.kinds.begin(), shown.kinds.end()),
            (std::set<std::uint32_t>{0, 1, 2, 3}));
  std::vector<std::uint32_t> kinds;
  double behind_m = 1e9, before_m = 0.0;  // of the snow
  const double pixels = 600.0 / (view.tangents.right - view.tangents.left);
  for (const shared::Particle& particle : seen) {
    const std::uint32_t kind = particle.kind & shared::kParticleKindMask;
    if (kinds.empty() || kinds.back() != kind) kinds.push_back(kind);
    const double range_m = glm::length(Vec3(particle.position));
    if (kind == shared::kParticleSnow)
      (kinds.size() < 4 ? behind_m : before_m) =
          kinds.size() < 4 ? std::min(behind_m, range_m) : std::max(before_m, range_m);
    if (kind == shared::kParticleBubble || kind == shared::kParticleBubbleSpot) {
      const bool spot = particle.radius_m * pixels / range_m < shared::kBubbleSpot_px;
      EXPECT_EQ(kind == shared::kParticleBubbleSpot, spot)
          << particle.radius_m << " at " << range_m;
    }
  }
  EXPECT_EQ(kinds, (std::vector<std::uint32_t>{shared::kParticleBubbleSpot, shared::kParticleBubble,
                                               shared::kParticleSnow, shared::kParticleSilt,
                                               shared::kParticleSnow}));
  // Cells of half a metre are on one side or the other.
  EXPECT_GT(behind_m, before_m - 1.0);
}

TEST(Silt, IsKickedUpOnlyNearTheBedAndSettles) {
  scene::Scene scene;
  scene.objects.resize(1);
  const scene::MotionSource motion(scene);
  scene::SiltSource source;
  source.object = 0;
  source.bed_depth_m = 10.0;
  std::vector<WorldParticle> silt;
  scene.objects[0].mount.pose.position_m.y = -8.0;
  add_silt(motion, source, 0, 1, 50.0, silt);
  EXPECT_TRUE(silt.empty());
  // A thing at rest on the bed raises none; one that moves over it does.
  scene.objects[0].mount.pose.position_m.y = -9.7;
  add_silt(motion, source, 0, 1, 50.0, silt);
  EXPECT_TRUE(silt.empty());
  class Goes final : public scene::SimulatedMotion {
   public:
    Vec3 from_m{0.0}, velocity_m_s{0.0};
    double wash_m_s = 0.0;
    std::optional<scene::MotionAt> at(std::size_t, double) const override { return std::nullopt; }
    std::optional<scene::FollowedPlace> followed(std::size_t, int, const Vec3&,
                                                 double time_s) const override {
      return scene::FollowedPlace{from_m + velocity_m_s * time_s, wash_m_s};
    }
  } goes;
  goes.from_m = Vec3(0.0, -9.7, 0.0);
  goes.velocity_m_s = Vec3(0.2, 0.0, 0.0);
  add_silt(scene::MotionSource(scene, &goes), source, 0, 1, 50.0, silt);
  EXPECT_GT(silt.size(), 10u);
  for (const WorldParticle& cloud : silt) {
    EXPECT_GT(cloud.position_m.y, -10.0);
    EXPECT_LT(cloud.position_m.y, -8.5);
    EXPECT_LE(cloud.opacity, 1.0);
    // It hangs where it was raised.
    EXPECT_LT(cloud.position_m.x, 10.0 + 1.0);
  }
  EXPECT_LT(silt.back().position_m.x, 5.0);
  // Out of the fins' reach, but thrusters drive water over the bed.
  goes.from_m.y = -7.0;
  silt.clear();
  add_silt(scene::MotionSource(scene, &goes), source, 0, 1, 50.0, silt);
  EXPECT_TRUE(silt.empty());
  goes.wash_m_s = 0.3;
  add_silt(scene::MotionSource(scene, &goes), source, 0, 1, 50.0, silt);
  EXPECT_GT(silt.size(), 10u);
}

TEST(GpuWaves, AreTheSameAsInDoubleNearTheOriginAndFarOut) {
  const SeaWaves sea(
      {.wind_m_s = 8.0, .fetch_m = 2e4, .direction_rad = 0.3, .components = 40, .seed = 2});
  for (const Vec3& origin : {Vec3(0.0), Vec3(1e7, -3.0, -2e7)})
    for (const double t : {0.0, 1e5}) {
      const shared::Waves waves = gpu_waves(sea, origin, t);
      ASSERT_EQ(waves.count, 40u);
      for (int i = 0; i < 50; ++i) {
        const float x = 1.7f * static_cast<float>(i), z = -0.9f * static_cast<float>(i);
        Vec3f sum(0.0f);
        for (std::uint32_t k = 0; k < waves.count; ++k)
          sum += shared::wave_surface(waves.waves[k], x, z);
        EXPECT_NEAR(sum.x, sea.height_m(origin.x + x, origin.z + z, t), 2e-3);
        EXPECT_NEAR(sum.y, sea.slope(origin.x + x, origin.z + z, t).x, 2e-3);
      }
      EXPECT_NEAR(waves.eye_height_m, sea.height_m(origin.x, origin.z, t), 1e-5);
      EXPECT_NEAR(waves.eye_slope.x, sea.slope(origin.x, origin.z, t).x, 1e-5);
      EXPECT_NEAR(waves.eye_slope.y, sea.slope(origin.x, origin.z, t).y, 1e-5);
    }
  EXPECT_EQ(gpu_waves(SeaWaves({.wind_m_s = 0.0}), Vec3(0.0), 1.0).count, 0u);
}

}  // namespace
}  // namespace neritic::render
