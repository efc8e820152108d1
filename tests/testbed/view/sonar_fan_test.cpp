// The live fan: an echo in one cell lights the pixels at its range and bearing, and no others.
#include <gtest/gtest.h>

#include "testbed/sensors/readback.hpp"
#include "testbed/view/dive_fan.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

TEST(FanShape, PlacesTheArcsEndsAtThePicturesEdges) {
  const sonar::Limits limits{.range_min_m = 1.0, .range_max_m = 5.0};
  const FanShape shape = fan_shape(limits, 400);
  EXPECT_EQ(shape.width, 400u);
  EXPECT_NEAR(shape.place(5.0, 0.0).x, 0.5, 1e-9);
  EXPECT_NEAR(shape.place(5.0, 0.0).y, 0.0, 1e-9);
  EXPECT_NEAR(shape.place(5.0, radians(-45.0)).x, 0.0, 1e-9);
  EXPECT_NEAR(shape.place(5.0, radians(45.0)).x, 1.0, 1e-9);
  EXPECT_NEAR(shape.place(1.0, radians(45.0)).y, 1.0, 0.01);
}

class SonarFansTest : public test::GpuTest {};

TEST_F(SonarFansTest, OneEchoLightsItsCellOnly) {
  const sonar::BeamGrid grid =
      sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(20.0), {40, 30, 10});
  constexpr std::uint32_t kRange = 25, kAzimuth = 21;
  std::vector<std::uint32_t> sums(40 * 30, 0);
  sums[kRange * 30 + kAzimuth] = 1 << 18;
  NERITIC_ASSERT_OK(const gpu::Buffer buffer,
                    gpu::Buffer::create(device(), {.name = "sums",
                                                   .size = sums.size() * 4,
                                                   .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                            VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  NERITIC_ASSERT_STATUS(gpu::upload_buffer(device(), buffer, std::as_bytes(std::span(sums))));
  NERITIC_ASSERT_OK(const auto fans, SonarFans::create(device()));
  NERITIC_ASSERT_OK(const auto frames, gpu::Frames::create(device(), 1));
  graph::Executor executor(*frames);
  ReadbackPool readback;
  graph::FrameGraph graph;
  fans->begin_frame();
  NERITIC_ASSERT_STATUS(
      fans->declare(graph, "sonar", {0, grid, graph.import_buffer("sums", buffer)}));
  const FanShape shape = *fans->shape(0);
  NERITIC_ASSERT_OK(const Readback texels,
                    readback.declare(graph, device(), "fan", fans->picture(graph, 0),
                                     VK_FORMAT_R8G8B8A8_UNORM, shape.width, shape.height, 1));
  NERITIC_ASSERT_OK(gpu::Commands * commands, frames->begin());
  NERITIC_ASSERT_OK(const graph::Plan* plan, executor.run(graph, *commands));
  (void)plan;
  NERITIC_ASSERT_OK(const std::uint64_t done, frames->submit());
  NERITIC_ASSERT_STATUS(frames->wait(done));

  const auto mapped = texels->mapped<std::uint8_t>();
  std::size_t lit = 0, shown = 0;
  for (std::uint32_t y = 0; y < shape.height; ++y)
    for (std::uint32_t x = 0; x < shape.width; ++x) {
      const auto* texel = &mapped[(std::size_t{y} * shape.width + x) * 4];
      // Where the pixel's centre is, from the picture's edges alone.
      const double right_m = shape.left_m + (x + 0.5) * shape.m_per_px;
      const double ahead_m = shape.top_m - (y + 0.5) * shape.m_per_px;
      const double range_m = std::hypot(right_m, ahead_m), bearing = std::atan2(right_m, ahead_m);
      const double edge_m = shape.m_per_px;  // pixels on an edge are mixed
      const double row_m = 1.0 + kRange * 0.1, column = radians(-45.0 + kAzimuth * 3.0);
      const double off_m = std::abs(bearing - (column + radians(1.5))) * range_m;
      const bool inside = range_m > row_m + edge_m && range_m < row_m + 0.1 - edge_m &&
                          off_m < radians(1.5) * range_m - edge_m;
      const bool outside = range_m < row_m - edge_m || range_m > row_m + 0.1 + edge_m ||
                           off_m > radians(1.5) * range_m + edge_m;
      if (inside) {
        EXPECT_GT(texel[0], 200) << x << ", " << y;
      } else if (outside) {
        EXPECT_LT(texel[0], 40) << x << ", " << y;
      }
      if (range_m > 5.0 + edge_m || range_m < 1.0 - edge_m) {
        EXPECT_EQ(texel[3], 0);
      }
      lit += inside;
      shown += texel[3] == 255;
    }
  EXPECT_GT(lit, 20u);
  const double area_px = radians(90.0) / 2.0 * (25.0 - 1.0) / (shape.m_per_px * shape.m_per_px);
  EXPECT_NEAR(static_cast<double>(shown), area_px, 0.02 * area_px);
}

// Half of the range, asked for while no ping comes: the newest is drawn again, brighter, and
// nothing beyond the arc.
TEST_F(SonarFansTest, APartOfTheRangeAndAGainAreSeenWithoutAPing) {
  const sonar::BeamGrid grid =
      sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(20.0), {40, 30, 10});
  std::vector<std::uint32_t> sums(40 * 30, 1 << 8);
  sums[0] = 1 << 18;
  NERITIC_ASSERT_OK(const gpu::Buffer buffer,
                    gpu::Buffer::create(device(), {.name = "sums",
                                                   .size = sums.size() * 4,
                                                   .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                            VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  NERITIC_ASSERT_STATUS(gpu::upload_buffer(device(), buffer, std::as_bytes(std::span(sums))));
  NERITIC_ASSERT_OK(const auto fans, SonarFans::create(device()));
  NERITIC_ASSERT_OK(const auto frames, gpu::Frames::create(device(), 1));
  graph::Executor executor(*frames);
  ReadbackPool readback;
  std::vector<double> brightness;
  for (const bool pings : {true, false, false}) {
    if (brightness.size() == 1) fans->show(0.25, 1.0);
    if (brightness.size() == 2) fans->show(0.25, 0.5);
    graph::FrameGraph graph;
    fans->begin_frame();
    if (pings)
      NERITIC_ASSERT_STATUS(
          fans->declare(graph, "sonar", {0, grid, graph.import_buffer("sums", buffer)}));
    NERITIC_ASSERT_STATUS(fans->redraw(graph));
    const FanShape shape = *fans->shape(0);
    NERITIC_ASSERT_OK(const Readback texels,
                      readback.declare(graph, device(), "fan", fans->picture(graph, 0),
                                       VK_FORMAT_R8G8B8A8_UNORM, shape.width, shape.height, 1));
    NERITIC_ASSERT_OK(gpu::Commands * commands, frames->begin());
    NERITIC_ASSERT_OK(const graph::Plan* plan, executor.run(graph, *commands));
    (void)plan;
    NERITIC_ASSERT_OK(const std::uint64_t done, frames->submit());
    NERITIC_ASSERT_STATUS(frames->wait(done));
    const auto mapped = texels->mapped<std::uint8_t>();
    const double shown_m = brightness.size() == 2 ? 3.0 : 5.0;
    EXPECT_NEAR(fans->grid(0)->limits.range_max_m, shown_m, 1e-9);
    double sum = 0.0, lit = 0.0;
    for (std::uint32_t y = 0; y < shape.height; ++y)
      for (std::uint32_t x = 0; x < shape.width; ++x) {
        const auto* texel = &mapped[(std::size_t{y} * shape.width + x) * 4];
        const double range_m = std::hypot(shape.left_m + (x + 0.5) * shape.m_per_px,
                                          shape.top_m - (y + 0.5) * shape.m_per_px);
        if (range_m > shown_m + shape.m_per_px) {
          EXPECT_EQ(texel[3], 0) << x << ", " << y;
        }
        if (range_m < 1.3 || range_m > 2.9 || texel[3] != 255) continue;
        sum += texel[0];
        lit += 1.0;
      }
    brightness.push_back(sum / lit);
  }
  EXPECT_LT(brightness[1], 0.8 * brightness[0]);
  EXPECT_NEAR(brightness[2], brightness[1], 2.0);
}

}  // namespace
}  // namespace neritic::testbed
