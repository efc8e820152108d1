// The overlay's pass draws what ImGui was asked for, over a cleared target, with the frame's
// pictures as textures.
#include "engine/xr/overlay.hpp"

#include <gtest/gtest.h>

#include "engine/xr/offscreen.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::xr {
namespace {

constexpr std::uint32_t kWidth = 64, kHeight = 48;

class OverlayTest : public test::GpuTest {
 protected:
  // Draws one frame and brings it back: RGBA8 texels.
  void draw(Overlay& overlay, Display& display, graph::FrameGraph& graph) {
    NERITIC_ASSERT_OK(const auto frames, gpu::Frames::create(device(), 1));
    graph::Executor executor(*frames);
    graph.output(overlay.declare(graph, import_target(graph, display)), display.target_access());
    NERITIC_ASSERT_OK(gpu::Commands * commands, frames->begin());
    NERITIC_ASSERT_OK(const graph::Plan* plan, executor.run(graph, *commands));
    EXPECT_EQ(plan->graph.passes.back().name, "overlay");
    NERITIC_ASSERT_OK(const std::uint64_t done, frames->submit());
    NERITIC_ASSERT_STATUS(frames->wait(done));
    NERITIC_ASSERT_OK(
        texels_, gpu::read_image(device(), display.target(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL));
  }
  std::array<int, 4> texel(std::uint32_t x, std::uint32_t y) const {
    std::array<int, 4> out{};
    for (std::size_t c = 0; c < 4; ++c)
      out[c] = static_cast<int>(texels_[(std::size_t{y} * kWidth + x) * 4 + c]);
    return out;
  }
  std::vector<std::byte> texels_;
};

using Texel = std::array<int, 4>;

TEST_F(OverlayTest, RectangleCoversItsPixelsAndNoOther) {
  NERITIC_ASSERT_OK(const auto display,
                    OffscreenDisplay::create(device(), {kWidth, kHeight, 30.0, true}));
  NERITIC_ASSERT_OK(const auto overlay,
                    Overlay::create(device(), nullptr, display->target().desc().format, 1.0f));
  graph::FrameGraph graph;
  overlay->begin(kWidth, kHeight, 0.01);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.Flags = ImDrawListFlags_None;  // exact edges
  list.AddRectFilled(ImVec2(10, 20), ImVec2(30, 25), IM_COL32(200, 100, 50, 255));
  draw(*overlay, *display, graph);
  EXPECT_EQ(texel(10, 20), (Texel{200, 100, 50, 255}));
  EXPECT_EQ(texel(29, 24), (Texel{200, 100, 50, 255}));
  for (const auto& [x, y] : {std::pair{9u, 20u}, {30u, 20u}, {10u, 19u}, {10u, 25u}})
    EXPECT_EQ(texel(x, y), (Texel{0, 0, 0, 255})) << x << ", " << y;
}

TEST_F(OverlayTest, HalfTransparentInkMixesEvenlyWithWhatIsUnder) {
  NERITIC_ASSERT_OK(const auto display,
                    OffscreenDisplay::create(device(), {kWidth, kHeight, 30.0, true}));
  NERITIC_ASSERT_OK(const auto overlay,
                    Overlay::create(device(), nullptr, display->target().desc().format, 1.0f));
  graph::FrameGraph graph;
  overlay->begin(kWidth, kHeight, 0.01);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(ImVec2(0, 0), ImVec2(kWidth, kHeight), IM_COL32(0, 200, 0, 255));
  list.AddRectFilled(ImVec2(0, 0), ImVec2(kWidth, kHeight), IM_COL32(200, 0, 0, 128));
  draw(*overlay, *display, graph);
  const Texel mixed = texel(kWidth / 2, kHeight / 2);
  EXPECT_NEAR(mixed[0], 200.0 * 128 / 255, 1.0);
  EXPECT_NEAR(mixed[1], 200.0 * 127 / 255, 1.0);
  EXPECT_EQ(mixed[2], 0);
}

TEST_F(OverlayTest, PictureOfTheGraphIsShownRightWayUp) {
  NERITIC_ASSERT_OK(const auto display,
                    OffscreenDisplay::create(device(), {kWidth, kHeight, 30.0, true}));
  NERITIC_ASSERT_OK(const auto overlay,
                    Overlay::create(device(), nullptr, display->target().desc().format, 1.0f));
  // Two by two texels: red green / blue white.
  NERITIC_ASSERT_OK(const gpu::Image picture,
                    gpu::Image::create(device(), {.name = "picture",
                                                  .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                  .width = 2,
                                                  .height = 2,
                                                  .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                                           VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                                  .array_view = true}));
  const std::array<std::uint32_t, 4> colors{0xff0000ffu, 0xff00ff00u, 0xffff0000u, 0xffffffffu};
  NERITIC_ASSERT_STATUS(gpu::upload_image(device(), picture, std::as_bytes(std::span(colors))));
  graph::FrameGraph graph;
  const graph::ImageHandle handle = graph.import_image(
      picture, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  overlay->begin(kWidth, kHeight, 0.01);
  ImGui::GetBackgroundDrawList()->AddImage(overlay->texture(handle), ImVec2(0, 0),
                                           ImVec2(kWidth, kHeight));
  draw(*overlay, *display, graph);
  EXPECT_EQ(texel(2, 2), (Texel{255, 0, 0, 255}));
  EXPECT_EQ(texel(kWidth - 3, 2), (Texel{0, 255, 0, 255}));
  EXPECT_EQ(texel(2, kHeight - 3), (Texel{0, 0, 255, 255}));
  EXPECT_EQ(texel(kWidth - 3, kHeight - 3), (Texel{255, 255, 255, 255}));
}

}  // namespace
}  // namespace neritic::xr
