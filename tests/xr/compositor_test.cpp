// Layers on a display without a compositor of its own: the picture is scaled to each group, and
// panels lie where a pinhole projects them, in each view.
#include "engine/xr/compositor.hpp"

#include <gtest/gtest.h>

#include "tests/xr/shown.hpp"

namespace neritic::xr {
namespace {

constexpr Texel kBlack{0, 0, 0, 255}, kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255};

class CompositorTest : public test::GpuTest {
 protected:
  Shown show(const OffscreenOptions& options, graph::FrameGraph& graph, const Pose& world_from_head,
             const std::vector<Layer>& layers, std::size_t group = 0) {
    const auto display = OffscreenDisplay::create(device(), options).value();
    EXPECT_TRUE(display->declare(graph, world_from_head, layers).ok());
    return run_and_read(device(), graph, display->picture(group));
  }
};

// Pixel of a point by the pinhole equations alone.
Vec2 pixel_of(const ViewGroup& group, std::size_t view, const Vec3& point_in_head) {
  const View& v = group.views[view];
  const Vec3 p = inverse(v.head_from_view) * point_in_head;
  const double x = p.x / -p.z, y = p.y / -p.z;
  return {(x - v.tangents.left) / (v.tangents.right - v.tangents.left) * group.width,
          (v.tangents.top - y) / (v.tangents.top - v.tangents.bottom) * group.height};
}

// A panel straight ahead whose left upper corner lies at a place in pixels.
PanelLayer panel_at(const ViewGroup& group, double left, double top, double width, double height) {
  const FrustumTangents& t = group.views[0].tangents;
  const double across = (t.right - t.left) / group.width, down = (t.top - t.bottom) / group.height;
  return {.pose = Pose{Vec3(t.left + across * (left + 0.5 * width),
                            t.top - down * (top + 0.5 * height), -1.0)},
          .size_m = {across * width, down * height}};
}

TEST(TexelOnPixel, APanelOfWholePixelsHasItsCornerAndNoOtherHasOne) {
  const ViewGroup group = one_view(64, 48, 1.0);
  const auto corner = texel_on_pixel(panel_at(group, 13, -7, 20, 10), group, {}, 20, 10);
  ASSERT_TRUE(corner);
  EXPECT_EQ(corner->left, 13);
  EXPECT_EQ(corner->top, -7);
  EXPECT_FALSE(texel_on_pixel(panel_at(group, 13.4, 7, 20, 10), group, {}, 20, 10));
  EXPECT_FALSE(texel_on_pixel(panel_at(group, 13, 7, 20, 10), group, {}, 21, 10));
  PanelLayer turned = panel_at(group, 13, 7, 20, 10);
  turned.pose.rotation = glm::angleAxis(0.02, Vec3(0, 1, 0));
  EXPECT_FALSE(texel_on_pixel(turned, group, {}, 20, 10));
  PanelLayer behind = panel_at(group, 13, 7, 20, 10);
  behind.pose.position_m.z = 1.0;
  EXPECT_FALSE(texel_on_pixel(behind, group, {}, 20, 10));
  ViewGroup pair = group;
  pair.views.push_back(pair.views[0]);
  EXPECT_FALSE(texel_on_pixel(panel_at(group, 13, 7, 20, 10), pair, {}, 20, 10));
}

TEST_F(CompositorTest, NoLayersShowBlack) {
  graph::FrameGraph graph;
  const Shown shown = show({{one_view(8, 4, 1.0)}}, graph, {}, {});
  EXPECT_EQ(shown.at(0, 0), kBlack);
  EXPECT_EQ(shown.at(7, 3), kBlack);
}

TEST_F(CompositorTest, ThePictureIsScaledToItsGroupAndEachViewKeepsItsLayer) {
  graph::FrameGraph graph;
  ViewGroup pair = one_view(32, 16, 1.0);
  pair.views.push_back(pair.views[0]);
  const graph::ImageHandle picture =
      flat_image(graph, "picture", 8, 4, {{1, 0, 0, 1}, {0, 1, 0, 1}});
  const Shown shown = show({{pair}}, graph, {}, {ProjectionLayer{.color = picture}});
  for (const auto& [x, y] : {std::pair{0u, 0u}, {31u, 15u}, {13u, 7u}}) {
    EXPECT_EQ(shown.at(x, y, 0), kRed);
    EXPECT_EQ(shown.at(x, y, 1), kGreen);
  }
}

TEST_F(CompositorTest, AGroupWithoutItsOwnPictureIsBlack) {
  graph::FrameGraph graph;
  const OffscreenOptions options{{one_view(8, 8, 1.0), one_view(4, 4, 0.5)}};
  const graph::ImageHandle picture = flat_image(graph, "picture", 8, 8, {{1, 0, 0, 1}});
  EXPECT_EQ(show(options, graph, {}, {ProjectionLayer{.group = 0, .color = picture}}, 1).at(2, 2),
            kBlack);
}

// Two eyes, 64 mm apart, each with more to its outer side, turned outwards a little.
ViewGroup canted_pair(std::uint32_t width, std::uint32_t height) {
  return {width,
          height,
          {{{{-0.032, 0, 0}, from_yaw_pitch_roll(0.1, 0.0, 0.0)}, {-1.3, 0.8, -1.1, 0.9}},
           {{{0.032, 0, 0}, from_yaw_pitch_roll(-0.1, 0.0, 0.0)}, {-0.8, 1.3, -1.1, 0.9}}}};
}

TEST_F(CompositorTest, PanelsLieWhereEachAsymmetricViewProjectsThem) {
  const ViewGroup pair = canted_pair(210, 200);
  const Pose world_from_head{{40.0, -7.0, 3.0}, from_yaw_pitch_roll(1.0, 0.2, 0.1)};
  const Pose head_from_panel{{0.1, -0.05, -1.5}, from_yaw_pitch_roll(0.4, 0.0, 0.0)};
  for (const auto lock : {PanelLayer::Lock::kHead, PanelLayer::Lock::kWorld}) {
    graph::FrameGraph graph;
    PanelLayer panel{.image = flat_image(graph, "panel", 2, 2, {{0, 1, 0, 1}}),
                     .lock = lock,
                     .pose = head_from_panel,
                     .size_m = {0.6, 0.3}};
    if (lock == PanelLayer::Lock::kWorld) panel.pose = world_from_head * head_from_panel;
    const Shown shown = show({{pair}}, graph, world_from_head, {panel});
    for (std::uint32_t view = 0; view < 2; ++view)
      for (const double side : {-1.0, 1.0})
        for (const double up : {-1.0, 1.0}) {
          // A little inside each corner it is green, a little outside black.
          for (const double part : {0.94, 1.06}) {
            const Vec2 at = pixel_of(
                pair, view, head_from_panel * Vec3(side * part * 0.3, up * part * 0.15, 0.0));
            EXPECT_EQ(
                shown.at(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y), view),
                part < 1.0 ? kGreen : kBlack)
                << view << ": " << at.x << ", " << at.y;
          }
        }
  }
}

TEST_F(CompositorTest, PanelsAreDrawnInTheirOrderAndMixByAlpha) {
  graph::FrameGraph graph;
  // Colours are multiplied by alpha: half green over red.
  const std::vector<Layer> layers{
      ProjectionLayer{.color = flat_image(graph, "picture", 8, 8, {{0, 0, 1, 1}})},
      PanelLayer{.image = flat_image(graph, "under", 2, 2, {{1, 0, 0, 1}}),
                 .pose = Pose{{0, 0, -1}},
                 .size_m = {4, 4}},
      PanelLayer{.image = flat_image(graph, "over", 2, 2, {{0, 0.5f, 0, 0.5f}}),
                 .pose = Pose{{0, 0, -2}},
                 .size_m = {8, 8}}};
  const Shown shown = show({{one_view(8, 8, radians(90.0))}}, graph, {}, layers);
  EXPECT_NEAR(shown.at(3, 3)[0], 127, 1);
  EXPECT_NEAR(shown.at(3, 3)[1], 128, 1);
  EXPECT_EQ(shown.at(3, 3)[2], 0);
}

TEST_F(CompositorTest, APanelBehindTheHeadIsNotSeen) {
  graph::FrameGraph graph;
  const PanelLayer panel{.image = flat_image(graph, "panel", 2, 2, {{0, 1, 0, 1}}),
                         .pose = Pose{{0, 0, 1}},
                         .size_m = {4, 4}};
  EXPECT_EQ(show({{one_view(8, 8, radians(90.0))}}, graph, {}, {panel}).at(4, 4), kBlack);
}

}  // namespace
}  // namespace neritic::xr
