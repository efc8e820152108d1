// Focus and shutter on made pictures: an edge out of focus is that of a disk of the thin lens's
// radius, one that moves is a ramp as long as its way, and a rolling shutter leans it. So does a
// bar's before what stands still.
#include <gtest/gtest.h>

#include <functional>
#include <glm/gtc/packing.hpp>

#include "engine/gpu/frames.hpp"
#include "engine/render/renderer.hpp"
#include "testbed/sensors/readback.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using ExposurePasses = test::GpuTest;

constexpr std::uint32_t kWide = 128, kHigh = 64;
constexpr double kEdge = 64.0;

gpu::Image image_of(gpu::Device& device, const char* name, const std::function<Vec4(int)>& column) {
  auto image = gpu::Image::create(
      device,
      {name, render::kHdrFormat, kWide, kHigh, 1, 1,
       VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
       true});
  EXPECT_TRUE(image.ok());
  std::vector<std::uint16_t> texels;
  for (std::uint32_t y = 0; y < kHigh; ++y)
    for (std::uint32_t x = 0; x < kWide; ++x)
      for (int i = 0; i < 4; ++i)
        texels.push_back(glm::packHalf1x16(static_cast<float>(column(static_cast<int>(x))[i])));
  EXPECT_TRUE(gpu::upload_image(device, *image, std::as_bytes(std::span(texels))).ok());
  return std::move(*image);
}

// The columns of a picture, and its motion and depth.
struct Columns {
  std::function<Vec4(int)> light, motion, depth;
};

// The green of what a pass makes of columns; of a step from 0 to 1 at kEdge, beside another even
// image.
class Made {
 public:
  template <class Declare>
  Made(gpu::Device& device, const Vec4& other, Declare declare)
      : Made(device,
             {[](int x) { return Vec4(Vec3(x < kEdge ? 0.0 : 1.0), 1.0); },
              [=](int) { return other; }, [=](int) { return other; }},
             declare) {}
  template <class Declare>
  Made(gpu::Device& device, const Columns& columns, Declare declare) {
    auto renderer = render::Renderer::create(device);
    auto frames = gpu::Frames::create(device);
    EXPECT_TRUE(renderer.ok() && frames.ok());
    gpu::Image hdr = image_of(device, "light", columns.light);
    gpu::Image motion = image_of(device, "motion", columns.motion);
    gpu::Image depth = image_of(device, "depth", columns.depth);
    const graph::ImportState state{.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    graph::Executor executor(**frames);
    graph::FrameGraph graph;
    render::GBuffer gbuffer;
    gbuffer.width = kWide;
    gbuffer.height = kHigh;
    gbuffer.motion = graph.import_image(motion, state);
    gbuffer.depth = graph.import_image(depth, state);
    const auto out = declare(**renderer, graph, graph.import_image(hdr, state), gbuffer);
    EXPECT_TRUE(out.ok());
    ReadbackPool pool;
    auto pin = pool.declare(graph, device, "made", *out, render::kHdrFormat, kWide, kHigh, 1);
    EXPECT_TRUE(pin.ok());
    auto commands = (*frames)->begin();
    EXPECT_TRUE(executor.run(graph, **commands).ok());
    auto done = (*frames)->submit();
    EXPECT_TRUE(done.ok() && (*frames)->wait(*done).ok());
    for (const std::uint16_t half : (*pin)->template mapped<std::uint16_t>())
      values_.push_back(glm::unpackHalf1x16(half));
    device.wait_idle();
  }
  double at(std::uint32_t x, std::uint32_t y) const { return values_[(y * kWide + x) * 4 + 1]; }
  // Where the step lies in a row: how much of it is dark.
  double edge(std::uint32_t y) const {
    double sum = 0.0;
    for (std::uint32_t x = 0; x < kWide; ++x) sum += 1.0 - at(x, y);
    return sum;
  }

 private:
  std::vector<float> values_;
};

TEST_F(ExposurePasses, AnEdgeOutOfFocusIsThatOfTheThinLenssDisk) {
  // near 0.05 m; depth 0.05 / z. A lens of 8 mm seen at 2000 pixels: 8 (1 / z - 1 / 1) pixels.
  const auto focussed = [&](double z_m) {
    return Made(device(), Vec4(0.05 / z_m),
                [](render::Renderer& r, auto& graph, auto hdr, auto& g) {
                  return r.declare_focus(graph, "", hdr, g, {0.05f, 1.0f, 8.0f, 12.0f, 200});
                });
  };
  const Made sharp = focussed(1.0);
  EXPECT_NEAR(sharp.at(62, 30), 0.0, 1e-3);
  EXPECT_NEAR(sharp.at(65, 30), 1.0, 1e-3);
  // At half the distance the radius is 8 pixels. The part of a disk beyond the chord at half its
  // radius is 0.1955.
  const Made soft = focussed(0.5);
  for (const std::uint32_t y : {20u, 31u, 40u}) {
    EXPECT_NEAR(0.5 * (soft.at(67, y) + soft.at(68, y)), 1.0 - 0.1955, 0.06);
    EXPECT_NEAR(0.5 * (soft.at(59, y) + soft.at(60, y)), 0.1955, 0.06);
    EXPECT_NEAR(soft.at(54, y), 0.0, 0.01);
    EXPECT_NEAR(soft.at(74, y), 1.0, 0.01);
  }
}

// A surface at half a metre before one in focus at a metre: the picture before the lens has an edge
// at kEdge, and the nearer one's spots spread over the sharp one behind.
TEST_F(ExposurePasses, ANearEdgeOutOfFocusIsARampOverWhatIsSharpBehindIt) {
  const Columns near_right{[](int x) { return Vec4(Vec3(x < kEdge ? 0.0 : 1.0), 1.0); },
                           [](int) { return Vec4(0.0); },
                           [](int x) { return Vec4(x < kEdge ? 0.05 : 0.1); }};
  // The part of a disk beyond a chord at this share of its radius.
  const auto beyond = [](double share) {
    const double s = std::clamp(share, -1.0, 1.0);
    return (std::acos(s) - s * std::sqrt(1.0 - s * s)) / kPi;
  };
  // The widest spot that the lens has anywhere may be much wider than this one.
  for (const float spot_px : {4.0f, 8.0f}) {
    const Made made(device(), near_right, [=](render::Renderer& r, auto& graph, auto hdr, auto& g) {
      return r.declare_focus(graph, "", hdr, g, {0.05f, 1.0f, spot_px, 24.0f, 200});
    });
    for (std::uint32_t x = 54; x < 75; ++x) {
      double mean = 0.0;
      for (std::uint32_t y = 16; y < 48; ++y) mean += made.at(x, y) / 32.0;
      EXPECT_NEAR(mean, beyond((kEdge - (x + 0.5)) / spot_px), 0.06) << spot_px << ", " << x;
    }
  }
}

TEST_F(ExposurePasses, ASharpEdgeBeforeWhatIsOutOfFocusStaysSharp) {
  const Columns near_right{[](int x) { return Vec4(Vec3(x < kEdge ? 0.0 : 1.0), 1.0); },
                           [](int) { return Vec4(0.0); },
                           [](int x) { return Vec4(x < kEdge ? 0.005 : 0.05); }};
  const Made made(device(), near_right, [](render::Renderer& r, auto& graph, auto hdr, auto& g) {
    return r.declare_focus(graph, "", hdr, g, {0.05f, 1.0f, 8.0f, 12.0f, 200});
  });
  for (const std::uint32_t y : {20u, 31u, 40u}) {
    EXPECT_LT(made.at(61, y), 0.05);
    EXPECT_GT(made.at(66, y), 0.95);
  }
}

TEST_F(ExposurePasses, WhatMovesBecomesARampAndARollingShutterLeansIt) {
  const auto exposed = [&](shared::ShutterParams params) {
    return Made(device(), Vec4(8.0, 0.0, 0.0, 0.0),
                [=](render::Renderer& r, auto& graph, auto hdr, auto& g) {
                  return r.declare_shutter(graph, "", hdr, g, params);
                });
  };
  // 8 pixels to the next frame, open for half of that: 4 pixels.
  const Made blurred = exposed({.exposed = 0.5f, .samples = 32, .farthest_px = 32.0f});
  for (int i = -3; i <= 2; ++i) {
    const double middle = i + 0.5;  // of the pixel, from the edge
    EXPECT_NEAR(blurred.at(static_cast<std::uint32_t>(64 + i), 10),
                std::clamp(0.5 + middle / 4.0, 0.0, 1.0), 0.03)
        << i;
  }
  EXPECT_NEAR(blurred.edge(10), kEdge, 0.05);
  // Rows are read over one frame's time: the last one sees it 8 pixels on from the first.
  shared::ShutterParams rolling{
      .exposed = 0.01f, .readout = 1.0f, .samples = 4, .farthest_px = 32.0f};
  const Made leant = exposed(rolling);
  for (const std::uint32_t y : {0u, 16u, 32u, 63u})
    EXPECT_NEAR(leant.edge(y), kEdge + 8.0 * ((y + 0.5) / kHigh - 0.5), 0.1) << y;
  // Behind a lens that shows only the picture's middle half.
  rolling.by_lens = 1;
  for (std::uint32_t j = 0; j <= shared::kRowSteps; ++j)
    for (std::uint32_t i = 0; i <= shared::kRowSteps; ++i)
      rolling.row[j * (shared::kRowSteps + 1) + i] =
          std::clamp(2.0f * static_cast<float>(j) / shared::kRowSteps - 0.5f, 0.0f, 1.0f);
  const Made zoomed = exposed(rolling);
  for (const std::uint32_t y : {4u, 20u, 32u, 42u, 60u})
    EXPECT_NEAR(zoomed.edge(y),
                kEdge + 8.0 * (std::clamp(2.0 * (y + 0.5) / kHigh - 0.5, 0.0, 1.0) - 0.5), 0.1)
        << y;
}

// A bar of 26 pixels before what stands still.
class MovingBar : public ExposurePasses {
 protected:
  static constexpr int kFrom = 50, kUntil = 76;
  static constexpr double kWidth = kUntil - kFrom, kMiddle = 0.5 * (kFrom + kUntil);
  Made exposed(double motion_px, const shared::ShutterParams& params) {
    const auto inside = [](int x) { return x >= kFrom && x < kUntil; };
    return Made(device(),
                {[=](int x) { return Vec4(Vec3(inside(x) ? 1.0 : 0.0), 1.0); },
                 [=](int x) { return Vec4(inside(x) ? motion_px : 0.0, 0.0, 0.0, 0.0); },
                 [=](int x) { return Vec4(inside(x) ? 0.02 : 0.0); }},
                [=](render::Renderer& r, auto& graph, auto hdr, auto& g) {
                  return r.declare_shutter(graph, "", hdr, g, params);
                });
  }
  // The light of a row, and its middle.
  static std::pair<double, double> light(const Made& made, std::uint32_t y) {
    double sum = 0.0, moment = 0.0;
    for (std::uint32_t x = 0; x < kWide; ++x) {
      sum += made.at(x, y);
      moment += made.at(x, y) * (x + 0.5);
    }
    return {sum, moment / sum};
  }
};

TEST_F(MovingBar, EachRowOfARollingShutterShowsItWholeWhereItIsThen) {
  for (const double motion_px : {6.0, 40.0, -40.0}) {
    const Made made = exposed(
        motion_px, {.exposed = 0.003f, .readout = 1.0f, .samples = 8, .farthest_px = 32.0f});
    for (const std::uint32_t y : {0u, 5u, 16u, 32u, 50u, 63u}) {
      const auto [sum, middle] = light(made, y);
      const double shift = motion_px * ((y + 0.5) / kHigh - 0.5);
      EXPECT_NEAR(sum, kWidth, 0.1) << motion_px << ", row " << y;
      EXPECT_NEAR(middle, kMiddle + shift, 0.1) << motion_px << ", row " << y;
      for (double x = kFrom + shift + 1.0; x < kUntil + shift - 1.0; x += 1.0)
        EXPECT_NEAR(made.at(static_cast<std::uint32_t>(x), y), 1.0, 0.01) << motion_px << ": " << x;
    }
  }
}

TEST_F(MovingBar, BlurIsARampAsLongAsItsWayAtBothEdges) {
  constexpr double kWay = 20.0;
  const Made made = exposed(2.0 * kWay, {.exposed = 0.5f, .samples = 128, .farthest_px = 32.0f});
  EXPECT_NEAR(light(made, 20).first, kWidth, 0.2);
  for (std::uint32_t x = 30; x < 96; ++x) {
    const double at = x + 0.5;
    const double wanted = std::min(std::clamp(0.5 + (at - kFrom) / kWay, 0.0, 1.0),
                                   std::clamp(0.5 - (at - kUntil) / kWay, 0.0, 1.0));
    EXPECT_NEAR(made.at(x, 20), wanted, 0.03) << x;
  }
}

// A nearer thing hides the bar, whatever moves behind.
TEST_F(MovingBar, PassesBehindWhatIsNearer) {
  const auto near_by = [](int x) { return x < 40; };
  const auto inside = [](int x) { return x >= kFrom && x < kUntil; };
  const Made made(device(),
                  {[=](int x) {
                     return Vec4(Vec3(inside(x) ? 1.0 : near_by(x) ? 0.25 : 0.0), 1.0);
                   },
                   [=](int x) { return Vec4(inside(x) ? -40.0 : 0.0, 0.0, 0.0, 0.0); },
                   [=](int x) {
                     return Vec4(near_by(x) ? 0.05 : inside(x) ? 0.02 : 0.0);
                   }},
                  [=](render::Renderer& r, auto& graph, auto hdr, auto& g) {
                    return r.declare_shutter(
                        graph, "", hdr, g,
                        {.exposed = 0.003f, .readout = 1.0f, .samples = 8, .farthest_px = 32.0f});
                  });
  const std::uint32_t y = 63;  // the bar lies from 30.3 to 56.3 then
  for (std::uint32_t x = 0; x < 39; ++x) EXPECT_NEAR(made.at(x, y), 0.25, 0.01) << x;
  for (std::uint32_t x = 41; x < 55; ++x) EXPECT_NEAR(made.at(x, y), 1.0, 0.01) << x;
  for (std::uint32_t x = 58; x < kWide; ++x) EXPECT_NEAR(made.at(x, y), 0.0, 0.01) << x;
}

TEST_F(ExposurePasses, WhatHasNoMotionStaysAsItIs) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Made made(device(), Vec4(nan, nan, 0.0, 0.0),
                  [](render::Renderer& r, auto& graph, auto hdr, auto& g) {
                    return r.declare_shutter(
                        graph, "", hdr, g,
                        {.exposed = 0.5f, .readout = 1.0f, .samples = 8, .farthest_px = 32.0f});
                  });
  for (const std::uint32_t y : {0u, 31u, 63u}) EXPECT_NEAR(made.edge(y), kEdge, 1e-3) << y;
}

}  // namespace
}  // namespace neritic::testbed
