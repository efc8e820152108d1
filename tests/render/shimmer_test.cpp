// Layers of water that bend sight: the shader's turn of a sight, and the picture's shift in pixels,
// against rays traced through the gradient of the refractive index in double.
#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "engine/gpu/frames.hpp"
#include "engine/render/renderer.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::render {
namespace {

using ShimmerGpu = test::GpuTest;

WaterColumn halocline(double thickness_m = 0.3, double slope = 0.1) {
  WaterColumn column{.temperature_c = 25.0, .salinity_psu = 2.0};
  column.layer[0] = {.depth_m = 12.0,
                     .thickness_m = thickness_m,
                     .temperature_c = 25.0,
                     .salinity_psu = 35.0,
                     .slope = slope,
                     .shortest_m = 0.4,
                     .longest_m = 3.0};
  column.count = 1;
  return column;
}
WaterColumn thermocline(double thickness_m = 0.5, double slope = 0.15) {
  WaterColumn column{.temperature_c = 22.0, .salinity_psu = 35.0};
  column.layer[0] = {.depth_m = 12.0,
                     .thickness_m = thickness_m,
                     .temperature_c = 12.0,
                     .salinity_psu = 35.0,
                     .slope = slope,
                     .shortest_m = 0.4,
                     .longest_m = 3.0};
  column.count = 1;
  return column;
}

// A ray of length_m through the column, whose layer the waves lift: r'' = (grad n - (grad n .
// t) t) / n by the arc length, in steps of Runge and Kutta's fourth order. Waves: as the view's
// origin, the eye, has them.
struct Tracer {
  const WaterColumn& column;
  const shared::ShimmerParams& params;
  Vec3 eye_m;

  double lift(const Vec3& p) const {
    double sum = 0.0;
    for (const shared::ShimmerWave& w : params.layers[0].waves) {
      const Vec2 number(w.number_m);
      sum += w.slope / glm::length(number) *
             std::sin(number.x * (p.x - eye_m.x) + number.y * (p.z - eye_m.z) + w.angle_rad);
    }
    return sum;
  }
  double index(const Vec3& p) const {
    return sea_refractive_index(column.at(-(p.y - lift(p))), 550.0);
  }
  Vec3 bend(const Vec3& p, const Vec3& t) const {
    constexpr double h = 1e-4;
    Vec3 g;
    for (int i = 0; i < 3; ++i) {
      Vec3 a = p, b = p;
      a[i] -= h;
      b[i] += h;
      g[i] = (index(b) - index(a)) / (2.0 * h);
    }
    return (g - glm::dot(g, t) * t) / index(p);
  }
  Vec3 end(const Vec3& direction, double length_m, int steps) const {
    Vec3 p = eye_m, t = direction;
    const double h = length_m / steps;
    for (int i = 0; i < steps; ++i) {
      const Vec3 k1 = bend(p, t), p2 = p + 0.5 * h * t, t2 = t + 0.5 * h * k1;
      const Vec3 k2 = bend(p2, t2), p3 = p + 0.5 * h * t2, t3 = t + 0.5 * h * k2;
      const Vec3 k3 = bend(p3, t3), p4 = p + h * t3, t4 = t + h * k3;
      const Vec3 k4 = bend(p4, t4);
      p += h / 6.0 * (t + 2.0 * t2 + 2.0 * t3 + t4);
      t = glm::normalize(t + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4));
    }
    return p;
  }
};

// As shaders/shimmer.comp adds it up.
Vec3 turn_of(const shared::ShimmerParams& params, const Vec3& direction, double length_m) {
  const shared::ShimmerLayer& layer = params.layers[0];
  const Vec3f d(direction);
  const float length = static_cast<float>(length_m);
  shared::ShimmerCrossing crossing =
      shared::shimmer_crossing(-layer.height_m, d.y, length, layer.sigma_m, layer.bend);
  const auto waves = [&](std::uint32_t count) {
    Vec3f sum(0.0f);
    for (std::uint32_t i = 0; i < count; ++i)
      sum += shared::shimmer_wave(layer.waves[i], Vec2f(d.x, d.z) * crossing.way_m, Vec2f(d.x, d.z),
                                  crossing.spread2);
    return sum;
  };
  crossing.way_m = shared::lifted_way(crossing, waves(5).y, length);
  const Vec3f there = waves(shared::kShimmerWaves);
  const Vec2f slope(there.x, there.z);
  return Vec3(shared::shimmer_turn(crossing, layer.bend, d, slope, length));
}

Vec3 towards(double down_deg, double turn_deg) {
  const double down = radians(down_deg), turn = radians(turn_deg);
  return {std::cos(down) * std::sin(turn), -std::sin(down), -std::cos(down) * std::cos(turn)};
}

TEST(Shimmer, TurnsSightsAsRaysThroughTheGradientGo) {
  double worst = 0.0;
  for (const WaterColumn& column : {thermocline(), thermocline(0.15), halocline(), halocline(0.8)})
    for (const double down_deg : {18.0, 35.0, 70.0, -25.0})
      for (const double turn_deg : {20.0, 140.0}) {
        const Vec3 eye(3.0, down_deg > 0.0 ? -10.0 : -13.5, -2.0);
        const shared::ShimmerParams params = shimmer_params(column, eye, 37.0, 5);
        const Vec3 d = towards(down_deg, turn_deg);
        const double length_m = 3.0 * 2.0 / std::abs(d.y);
        const Vec3 seen = glm::normalize(Tracer{column, params, eye}.end(d, length_m, 700) - eye);
        const Vec3 truth = seen - d, shown = turn_of(params, d, length_m);
        const double off = glm::length(shown - truth) / glm::length(truth);
        worst = std::max(worst, off);
        EXPECT_LT(off, 0.12) << down_deg << " down, " << turn_deg << ", thickness "
                             << column.layer[0].thickness_m << ": " << glm::length(truth) << " rad";
      }
  RecordProperty("worst_share", fmt::format("{:.3f}", worst));
}

TEST(Shimmer, StillWaterRefractsBySnellsLawAndStays) {
  const WaterColumn column = halocline(0.3, 0.0);
  const Vec3 eye(0.0, -10.0, 0.0);
  const double above = sea_refractive_index({25.0, 2.0}, 550.0),
               below = sea_refractive_index({25.0, 35.0}, 550.0);
  for (const double down_deg : {20.0, 40.0, 80.0}) {
    const Vec3 d = towards(down_deg, 0.0);
    // Far behind the layer the direction of what is seen is that of the refracted ray.
    const double level = above / below * std::cos(radians(down_deg));
    const Vec3 refracted(0.0, -std::sqrt(1.0 - level * level), -level);
    const Vec3 shown = turn_of(shimmer_params(column, eye, 0.0, 1), d, 1e6);
    EXPECT_NEAR(glm::length(shown), glm::length(refracted - d), 0.06 * glm::length(refracted - d))
        << down_deg;
    EXPECT_LT(shown.y, 0.0);
    EXPECT_EQ(shown, turn_of(shimmer_params(column, eye, 123.0, 9), d, 1e6));
  }
}

TEST(Shimmer, IsFiniteAndSmallWhereSightsAreLevelOrStartInTheLayer) {
  WaterColumn column = halocline(0.01, 0.5);
  for (const double height_m : {0.0, 1e-6, 0.004, -0.1, 5.0})
    for (const double down_deg : {0.0, 1e-9, 1e-3, 1.0, -2.0, 90.0})
      for (const double length_m : {1e-3, 1.0, 1e6}) {
        const Vec3 eye(1e7, -12.0 + height_m, -1e7);
        const Vec3 shown =
            turn_of(shimmer_params(column, eye, 1e9, 3), towards(down_deg, 10.0), length_m);
        EXPECT_TRUE(std::isfinite(glm::length(shown))) << height_m << " " << down_deg;
        EXPECT_LT(glm::length(shown), 0.5) << height_m << " " << down_deg << " " << length_m;
      }
  // Nothing turns on this side of the layer.
  EXPECT_EQ(turn_of(shimmer_params(column, {0.0, -8.0, 0.0}, 0.0, 3), towards(40.0, 0.0), 2.0),
            Vec3(0.0));
}

TEST(Shimmer, WavesRunAsFastAsTheLayersDensityLets) {
  const SeaWater above{25.0, 0.0};
  WaterLayer layer = halocline(0.01).layer[0];
  const double number = 2.0 * kPi / 20.0;
  const double light = sea_density_kg_m3(above), heavy = sea_density_kg_m3({25.0, 35.0});
  // A long wave on a thin layer: that between two waters (Lamb, art. 231).
  EXPECT_NEAR(internal_wave_s(above, layer, number),
              std::sqrt(9.80665 * number * (heavy - light) / (heavy + light)), 1e-3);
  layer.thickness_m = 5.0;
  EXPECT_LT(internal_wave_s(above, layer, 1e6),
            std::sqrt(9.80665 * (heavy - light) / (light * 5.0)));
  layer.salinity_psu = 0.0;
  EXPECT_EQ(internal_wave_s(above, layer, number), 0.0);
}

// A picture whose colour tells where it came from: red the column, green the row.
TEST_F(ShimmerGpu, ShiftsThePictureByThePixelsThatTracedRaysTell) {
  constexpr std::uint32_t kWide = 256, kHigh = 144;
  constexpr double kFar_m = 9.0, kNear_m = 0.02;
  const WaterColumn column = halocline();
  const auto image = [&](const char* name, VkFormat format, std::span<const std::byte> bytes) {
    auto made = gpu::Image::create(
        device(), {name, format, kWide, kHigh, 1, 1,
                   VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                       VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                   true});
    EXPECT_TRUE(made.ok());
    EXPECT_TRUE(gpu::upload_image(device(), *made, bytes).ok());
    return std::move(*made);
  };
  std::vector<std::uint16_t> texels;
  for (std::uint32_t y = 0; y < kHigh; ++y)
    for (std::uint32_t x = 0; x < kWide; ++x)
      for (const float value : {float(x), float(y), 0.0f, 1.0f})
        texels.push_back(glm::packHalf1x16(value));
  const std::vector<float> depths(kWide * kHigh, static_cast<float>(kNear_m / kFar_m));
  const gpu::Image hdr = image("picture", kHdrFormat, std::as_bytes(std::span(texels)));
  const gpu::Image depth = image("depth", VK_FORMAT_R32_SFLOAT, std::as_bytes(std::span(depths)));
  ViewSet views;
  views.width = kWide;
  views.height = kHigh;
  ViewDesc view;
  view.tangents = tangents_from_fov(radians(40.0), double(kWide) / kHigh);
  view.near_m = kNear_m;
  const Vec3 eye(3.0, -10.5, -2.0);
  view.world_from_view = {eye, glm::angleAxis(radians(-38.0), Vec3(1, 0, 0))};
  view.next_world_from_view = view.world_from_view;
  views.views.push_back(view);
  const auto frames = gpu::Frames::create(device());
  ASSERT_TRUE(frames.ok());
  graph::Executor executor(**frames);
  graph::FrameGraph graph;
  const graph::ImportState state{.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  GBuffer gbuffer;
  gbuffer.width = kWide;
  gbuffer.height = kHigh;
  gbuffer.depth = graph.import_image(depth, state);
  WaterPasses passes(device());
  const auto shifted = passes.declare_shimmer(graph, "", graph.import_image(hdr, state), gbuffer,
                                              views, column, 37.0, 5);
  ASSERT_TRUE(shifted.ok()) << shifted.error().message;
  const auto read = gpu::Buffer::create(
      device(),
      {"shifted", kWide * kHigh * 8, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::kReadback});
  ASSERT_TRUE(read.ok());
  struct Data {
    graph::BufferHandle to;
  };
  const graph::BufferHandle imported = graph.import_buffer("shifted", *read);
  const Data& pass = graph.add_pass<Data>(
      "read",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(*shifted, graph::Access::kTransferRead);
        data.to = builder.write(imported, graph::Access::kTransferWrite);
      },
      [&](const Data& data, graph::PassContext& context) {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {kWide, kHigh, 1};
        vkCmdCopyImageToBuffer(context.cmd(), context.image(*shifted).handle(),
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               context.buffer(data.to).handle(), 1, &region);
      });
  graph.output(pass.to, graph::Access::kHostRead);
  const auto commands = (*frames)->begin();
  ASSERT_TRUE(executor.run(graph, **commands).ok());
  ASSERT_TRUE((*frames)->wait((*frames)->submit().value()).ok());
  const auto halves = read->mapped<std::uint16_t>();
  const shared::ShimmerParams params = shimmer_params(column, eye, 37.0, 5);
  const Quat& q = view.world_from_view.rotation;
  double largest_px = 0.0, worst_px = 0.0;
  for (std::uint32_t y = 8; y < kHigh; y += 32)
    for (std::uint32_t x = 8; x < kWide; x += 60) {
      const auto& t = view.tangents;
      const Vec3 planar((x + 0.5) / kWide * (t.right - t.left) + t.left,
                        t.top - (y + 0.5) / kHigh * (t.top - t.bottom), -1.0);
      const Vec3 d = q * glm::normalize(planar);
      const Vec3 seen =
          glm::conjugate(q) *
          (Tracer{column, params, eye}.end(d, kFar_m * glm::length(planar), 500) - eye);
      const Vec2 at((seen.x / -seen.z - t.left) / (t.right - t.left) * kWide - 0.5,
                    (t.top - seen.y / -seen.z) / (t.top - t.bottom) * kHigh - 0.5);
      const std::size_t texel = 4 * (std::size_t{y} * kWide + x);
      const Vec2 shown(glm::unpackHalf1x16(halves[texel]), glm::unpackHalf1x16(halves[texel + 1]));
      if (at.x < 1 || at.y < 1 || at.x > kWide - 2.0 || at.y > kHigh - 2.0) continue;
      largest_px = std::max(largest_px, glm::length(at - Vec2(x, y)));
      worst_px = std::max(worst_px, glm::length(at - shown));
      EXPECT_LT(glm::length(at - shown), 0.1 + 0.1 * glm::length(at - Vec2(x, y)))
          << x << ", " << y << ": " << at.x << ", " << at.y << " by rays, " << shown.x << ", "
          << shown.y << " shown";
    }
  EXPECT_GT(largest_px, 1.0);
  RecordProperty("largest_px", fmt::format("{:.2f}", largest_px));
  RecordProperty("worst_px", fmt::format("{:.2f}", worst_px));
}

}  // namespace
}  // namespace neritic::render
