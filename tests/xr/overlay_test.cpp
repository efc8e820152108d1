// The overlay draws what ImGui was asked for into a panel's image, with the frame's pictures as
// textures; the panel covers the display texel on pixel.
#include "engine/xr/desktop/overlay.hpp"

#include <gtest/gtest.h>

#include "tests/xr/shown.hpp"

namespace neritic::xr {
namespace {

constexpr std::uint32_t kWidth = 64, kHeight = 48;

class OverlayTest : public test::GpuTest {
 protected:
  // Draws one frame on black and brings it back. A view of 90 degrees, so that the panel is 1 m
  // ahead and 2 m high.
  void draw(Overlay& overlay, graph::FrameGraph& graph) {
    NERITIC_ASSERT_OK(
        const auto display,
        OffscreenDisplay::create(device(), {{one_view(kWidth, kHeight, radians(90.0))}}));
    const std::vector<Layer> layers{PanelLayer{.name = "overlay",
                                               .image = overlay.declare(graph),
                                               .pose = Pose{{0, 0, -1}},
                                               .size_m = {2.0 * kWidth / kHeight, 2.0},
                                               .parts = overlay.drawn()}};
    NERITIC_ASSERT_OK(const ShownPicture picture, display->declare(graph, {}, layers));
    EXPECT_EQ(picture.width, kWidth);
    shown_ = run_and_read(device(), graph, display->picture(0));
  }
  Texel texel(std::uint32_t x, std::uint32_t y) const { return shown_.at(x, y); }

 private:
  Shown shown_;
};

TEST_F(OverlayTest, RectangleCoversItsPixelsAndNoOther) {
  NERITIC_ASSERT_OK(const auto overlay, Overlay::create(device(), nullptr, 1.0f));
  graph::FrameGraph graph;
  overlay->begin(kWidth, kHeight, 0.01);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.Flags = ImDrawListFlags_None;  // exact edges
  list.AddRectFilled(ImVec2(10, 20), ImVec2(30, 25), IM_COL32(200, 100, 50, 255));
  draw(*overlay, graph);
  EXPECT_EQ(texel(10, 20), (Texel{200, 100, 50, 255}));
  EXPECT_EQ(texel(29, 24), (Texel{200, 100, 50, 255}));
  for (const auto& [x, y] : {std::pair{9u, 20u}, {30u, 20u}, {10u, 19u}, {10u, 25u}})
    EXPECT_EQ(texel(x, y), (Texel{0, 0, 0, 255})) << x << ", " << y;
}

// As when all panels are hidden, or an error ended a frame.
TEST_F(OverlayTest, FramesThatNobodyDeclaresAreDropped) {
  NERITIC_ASSERT_OK(const auto overlay, Overlay::create(device(), nullptr, 1.0f));
  for (const std::uint32_t height : {kHeight, kHeight, 2160u, kHeight}) {
    NERITIC_ASSERT_STATUS(overlay->fit(height));
    overlay->begin(kWidth, kHeight, 0.01);
    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0, 0), ImVec2(kWidth, kHeight),
                                                  IM_COL32(200, 0, 0, 255));
  }
  graph::FrameGraph graph;
  overlay->begin(kWidth, kHeight, 0.01);
  draw(*overlay, graph);
  EXPECT_EQ(texel(10, 20), (Texel{0, 0, 0, 255}));
}

TEST_F(OverlayTest, HalfTransparentInkMixesEvenlyWithWhatIsUnder) {
  NERITIC_ASSERT_OK(const auto overlay, Overlay::create(device(), nullptr, 1.0f));
  graph::FrameGraph graph;
  overlay->begin(kWidth, kHeight, 0.01);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(ImVec2(0, 0), ImVec2(kWidth, kHeight), IM_COL32(0, 200, 0, 255));
  list.AddRectFilled(ImVec2(0, 0), ImVec2(kWidth, kHeight), IM_COL32(200, 0, 0, 128));
  draw(*overlay, graph);
  const Texel mixed = texel(kWidth / 2, kHeight / 2);
  EXPECT_NEAR(mixed[0], 200.0 * 128 / 255, 1.0);
  EXPECT_NEAR(mixed[1], 200.0 * 127 / 255, 1.0);
  EXPECT_EQ(mixed[2], 0);
}

// Otherwise a window would blend every pixel of its screen.
TEST_F(OverlayTest, OnlyThePartsThatWereDrawnAreLaidOver) {
  NERITIC_ASSERT_OK(const auto overlay, Overlay::create(device(), nullptr, 1.0f));
  graph::FrameGraph graph;
  overlay->begin(kWidth, kHeight, 0.01);
  const auto window = [](const char* name, ImVec2 at, ImVec2 size) {
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::Begin(name, nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + size.x, at.y + size.y),
                                              IM_COL32(10, 20, 30, 255));
    ImGui::End();
  };
  window("a", {0, 0}, {33, 34});
  window("b", {20, 10}, {33, 34});  // over the first
  ImGui::GetForegroundDrawList()->AddRectFilled(ImVec2(60, 44), ImVec2(80, 60),
                                                IM_COL32(200, 200, 200, 255));  // over the edge
  draw(*overlay, graph);
  double area = 0.0;
  for (const PanelPart& part : overlay->drawn()) {
    EXPECT_GE(part.left, 0.0);
    EXPECT_LE(part.right, 1.0);
    area += (part.right - part.left) * (part.bottom - part.top);
  }
  EXPECT_GE(overlay->drawn().size(), 2u);
  EXPECT_LT(area, 0.85);  // 53 x 44 of 64 x 48, and the corner
  EXPECT_EQ(texel(25, 20), (Texel{10, 20, 30, 255}));
  EXPECT_EQ(texel(62, 46), (Texel{200, 200, 200, 255}));
  EXPECT_EQ(texel(62, 2), (Texel{0, 0, 0, 255}));
}

TEST_F(OverlayTest, PictureOfTheGraphIsShownRightWayUp) {
  NERITIC_ASSERT_OK(const auto overlay, Overlay::create(device(), nullptr, 1.0f));
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
  const graph::ImageHandle handle =
      graph.import_image(picture, {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  overlay->begin(kWidth, kHeight, 0.01);
  ImGui::GetBackgroundDrawList()->AddImage(overlay->texture(handle), ImVec2(0, 0),
                                           ImVec2(kWidth, kHeight));
  draw(*overlay, graph);
  EXPECT_EQ(texel(2, 2), (Texel{255, 0, 0, 255}));
  EXPECT_EQ(texel(kWidth - 3, 2), (Texel{0, 255, 0, 255}));
  EXPECT_EQ(texel(2, kHeight - 3), (Texel{0, 0, 255, 255}));
  EXPECT_EQ(texel(kWidth - 3, kHeight - 3), (Texel{255, 255, 255, 255}));
}

}  // namespace
}  // namespace neritic::xr
