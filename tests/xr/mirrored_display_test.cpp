// A window beside a headset: it shows the middle of the wearer's first view with all panels, the
// headset none of the operator's; without a wearer the window is the display.
#include "engine/xr/desktop/mirrored_display.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/xr/shown.hpp"

namespace neritic::xr {
namespace {

constexpr Texel kPortRed{255, 0, 0, 255}, kAheadGreen{0, 255, 0, 255},
    kPanelWhite{255, 255, 255, 255};
constexpr double kPress = 1.0, kOtherPress = 2.0;  // of the headset, of the window

// A pair of views that look more outwards than inwards, as real ones do.
ViewGroup pair_of_views() {
  const View left{Pose{Vec3(-0.03, 0.0, 0.0)}, {-1.2, 0.8, -0.7, 0.9}, {}};
  const View right{Pose{Vec3(0.03, 0.0, 0.0)}, {-0.8, 1.2, -0.7, 0.9}, {}};
  return {100, 80, {left, right}};
}

struct WornHeadset final : Display {
  FrameVerdict verdict = FrameVerdict::kDraw;
  std::vector<Layer> layers;  // of the last frame
  std::vector<bool> ended;    // frames, whether they were submitted
  Pose world_from_head{Vec3(5, 6, 7)};
  Result<DisplayFrame> begin_frame(const Pose&) override {
    DisplayFrame frame;
    frame.verdict = verdict;
    if (verdict != FrameVerdict::kDraw) return frame;
    frame.world_from_head = world_from_head;
    frame.groups = {pair_of_views()};
    return frame;
  }
  bool paces_device() const override { return true; }
  Result<ShownPicture> declare(graph::FrameGraph&, const Pose&,
                               std::span<const Layer> shown) override {
    layers.assign(shown.begin(), shown.end());
    return ShownPicture{};
  }
  gpu::Frames::SubmitSync sync() const override { return {}; }
  Status end_frame(bool submitted) override {
    ended.push_back(submitted);
    return {};
  }
  ActionValues take_actions(const InputClaims&) override { return ActionValues({kPress}); }
};

// Its picture is an image.
struct WatchedWindow final : WindowDisplay {
  gpu::Device& device;
  FrameVerdict verdict = FrameVerdict::kDraw;
  std::unique_ptr<Compositor> compositor;
  gpu::Image image;
  int begun = 0, ended = 0;
  bool waited = false;
  explicit WatchedWindow(gpu::Device& on)
      : device(on),
        compositor(Compositor::create(on, VK_FORMAT_R8G8B8A8_UNORM).value()),
        image(gpu::Image::create(
                  on, {.name = "window",
                       .format = VK_FORMAT_R8G8B8A8_UNORM,
                       .width = 64,
                       .height = 48,
                       .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT})
                  .value()) {}
  Result<DisplayFrame> begin_frame(const Pose&) override {
    ++begun;
    waited = waits_;
    DisplayFrame frame;
    frame.verdict = verdict;
    group_ = one_view(64, 48, 1.0);
    if (verdict == FrameVerdict::kDraw) frame.groups = {group_};
    return frame;
  }
  Result<ShownPicture> declare(graph::FrameGraph& graph, const Pose& world_from_head,
                               std::span<const Layer> layers) override {
    NERITIC_TRY(const graph::ImageHandle composed,
                compositor->declare(graph, "window", graph.import_image(image, {}), group_, 0,
                                    world_from_head, layers));
    graph.output(composed, graph::Access::kTransferRead);
    return ShownPicture{composed, VK_FORMAT_R8G8B8A8_UNORM, 64, 48, true};
  }
  gpu::Frames::SubmitSync sync() const override { return {.signal_value = 7}; }
  Status end_frame(bool submitted) override {
    ended += submitted;
    return {};
  }
  ActionValues take_actions(const InputClaims&) override { return ActionValues({kOtherPress}); }
};

// Both views red, but the first green from straight ahead to the right.
graph::ImageHandle picture_of_views(graph::FrameGraph& graph) {
  const graph::ImageHandle red = flat_image(graph, "views", 100, 80, {{1, 0, 0, 1}, {1, 0, 0, 1}});
  const graph::ImageHandle green = flat_image(graph, "green", 40, 80, {{0, 1, 0, 1}});
  struct Data {
    graph::ImageHandle from, to;
  };
  return graph
      .add_pass<Data>(
          "paint",
          [&](graph::PassBuilder& builder, Data& data) {
            data.from = green;
            builder.read(green, graph::Access::kTransferRead);
            data.to = builder.write(red.layer(0), graph::Access::kTransferWrite);
          },
          [](const Data& data, graph::PassContext& context) {
            VkImageCopy region{};
            region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.dstOffset = {60, 0, 0};
            region.extent = {40, 80, 1};
            vkCmdCopyImage(context.cmd(), context.image(data.from).handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, context.image(data.to).handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
          })
      .to.whole();
}

class MirroredDisplayTest : public test::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped()) return;
    auto made = std::make_unique<WatchedWindow>(device());
    window_ = made.get();
    both_.emplace(headset_, std::move(made));
  }
  DisplayFrame begin() { return both_->begin_frame({}).value(); }

  WornHeadset headset_;
  WatchedWindow* window_ = nullptr;
  std::optional<MirroredDisplay> both_;
};

TEST(MirroredPart, IsTheLargestOfThatAspectRoundWhatIsStraightAhead) {
  const FrustumTangents part = mirrored_part({-1.2, 0.8, -0.7, 0.9}, 4.0 / 3.0);
  EXPECT_NEAR(part.left, -0.8, 1e-12);
  EXPECT_NEAR(part.right, 0.8, 1e-12);
  EXPECT_NEAR(part.bottom, -0.6, 1e-12);
  EXPECT_NEAR(part.top, 0.6, 1e-12);
  const FrustumTangents high = mirrored_part({-1.2, 0.8, -0.7, 0.9}, 0.5);
  EXPECT_NEAR(high.top, 0.7, 1e-12);
  EXPECT_NEAR(high.left, -0.35, 1e-12);
}

TEST(MirroredPart, OfAViewThatLooksAsideIsAllOfIt) {
  const FrustumTangents aside{0.1, 0.8, -0.7, 0.9};
  EXPECT_EQ(mirrored_part(aside, 1.5).left, 0.1);
  EXPECT_EQ(mirrored_part(aside, 1.5).top, 0.9);
  EXPECT_EQ(mirrored_part({-1, 1, -1, 1}, std::nan("")).left, -1.0);
}

TEST_F(MirroredDisplayTest, TheWindowShowsTheMiddleOfTheFirstViewAndPanelsInTheirPlaces) {
  const DisplayFrame frame = begin();
  ASSERT_TRUE(frame.mirror);
  EXPECT_EQ(frame.mirror->width, 64u);
  EXPECT_FALSE(window_->waited);
  graph::FrameGraph graph;
  // A panel of the world's, 2 m ahead of the head and 0.4 m above it, 0.2 m wide.
  const PanelLayer instrument{.name = "instrument",
                              .image = flat_image(graph, "panel", 4, 4, {{1, 1, 1, 1}}),
                              .lock = PanelLayer::Lock::kWorld,
                              .pose = Pose{Vec3(5, 6.4, 5)},
                              .size_m = Vec2(0.2)};
  const Layer views = ProjectionLayer{.color = picture_of_views(graph)};
  ASSERT_TRUE(
      both_->declare(graph, *frame.world_from_head, std::vector<Layer>{views, instrument}).ok());
  const Shown shown = run_and_read(device(), graph, window_->image);
  for (const std::uint32_t y : {1u, 30u, 46u}) {
    EXPECT_EQ(shown.at(30, y), kPortRed) << y;
    EXPECT_EQ(shown.at(33, y), kAheadGreen) << y;
  }
  // Seen from the eye 0.03 m to the left: tangents 0.015 and 0.2, of 0.8 and 0.6.
  const double x = 32.0 + 32.0 * 0.015 / 0.8, y = 24.0 - 24.0 * 0.2 / 0.6;
  const double half_x = 32.0 * 0.05 / 0.8, half_y = 24.0 * 0.05 / 0.6;
  EXPECT_EQ(shown.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)), kPanelWhite);
  const auto white_from = [&](double from, double to, bool across) {
    int count = 0;
    for (auto i = static_cast<std::uint32_t>(from); i < static_cast<std::uint32_t>(to); ++i)
      count += (across ? shown.at(i, static_cast<std::uint32_t>(y))
                       : shown.at(static_cast<std::uint32_t>(x), i)) == kPanelWhite;
    return count;
  };
  EXPECT_NEAR(white_from(0, 64, true), 2.0 * half_x, 1.0);
  EXPECT_NEAR(white_from(0, 48, false), 2.0 * half_y, 1.0);
}

TEST_F(MirroredDisplayTest, PanelsOfTheOperatorAreInTheWindowAlone) {
  const DisplayFrame frame = begin();
  graph::FrameGraph graph;
  const Layer views = ProjectionLayer{.color = picture_of_views(graph)};
  PanelLayer all{.name = "operator",
                 .image = flat_image(graph, "panel", 4, 4, {{1, 1, 1, 1}}),
                 .pose = frame.mirror->views[0].head_from_view * Pose{Vec3(0, 0, -1)},
                 .size_m = Vec2(4.0)};
  all.mirror_only = true;
  // A headset shows the last picture of this one; the window has none.
  const PanelLayer kept{.name = "kept"};
  ASSERT_TRUE(
      both_->declare(graph, *frame.world_from_head, std::vector<Layer>{views, all, kept}).ok());
  EXPECT_EQ(headset_.layers.size(), 2u);
  EXPECT_EQ(std::get<PanelLayer>(headset_.layers[1]).name, "kept");
  EXPECT_EQ(run_and_read(device(), graph, window_->image).at(5, 5), kPanelWhite);
  EXPECT_EQ(both_->sync().signal_value, 7u);
  ASSERT_TRUE(both_->end_frame(true).ok());
  EXPECT_THAT(headset_.ended, testing::ElementsAre(true));
  EXPECT_EQ(window_->ended, 1);
}

TEST_F(MirroredDisplayTest, TheWindowTakesThirtyPicturesASecondAtMostAndHoldsUpNone) {
  EXPECT_TRUE(begin().mirror);
  ASSERT_TRUE(both_->end_frame(true).ok());
  for (int i = 0; i < 3; ++i) {
    const DisplayFrame next = begin();
    EXPECT_EQ(next.verdict, FrameVerdict::kDraw);
    EXPECT_FALSE(next.mirror);
    EXPECT_EQ(both_->sync().signal_value, 0u);
    ASSERT_TRUE(both_->end_frame(true).ok());
  }
  EXPECT_EQ(window_->begun, 1);
  EXPECT_EQ(window_->ended, 1);
  std::this_thread::sleep_for(std::chrono::milliseconds(35));
  window_->verdict = FrameVerdict::kHidden;  // minimised
  const DisplayFrame frame = begin();
  EXPECT_EQ(frame.verdict, FrameVerdict::kDraw);
  EXPECT_FALSE(frame.mirror);
}

TEST_F(MirroredDisplayTest, WithoutAWearerTheWindowIsTheDisplay) {
  headset_.verdict = FrameVerdict::kHidden;
  const DisplayFrame frame = begin();
  EXPECT_EQ(frame.verdict, FrameVerdict::kDraw);
  EXPECT_FALSE(frame.world_from_head);
  EXPECT_FALSE(frame.mirror);
  EXPECT_TRUE(window_->waited);
  EXPECT_FALSE(both_->paces_device());
  EXPECT_EQ(both_->take_actions({})[0], kOtherPress);
  EXPECT_EQ(both_->take_mirror_actions({})[0], 0.0);
  graph::FrameGraph graph;
  const Layer view = ProjectionLayer{.color = flat_image(graph, "view", 8, 8, {{0, 1, 0, 1}})};
  ASSERT_TRUE(both_->declare(graph, {}, std::vector<Layer>{view}).ok());
  EXPECT_TRUE(headset_.layers.empty());
  EXPECT_EQ(run_and_read(device(), graph, window_->image).at(5, 5), kAheadGreen);
  ASSERT_TRUE(both_->end_frame(true).ok());
  EXPECT_THAT(headset_.ended, testing::ElementsAre(false));
  EXPECT_EQ(window_->ended, 1);

  headset_.verdict = FrameVerdict::kDraw;  // put on
  EXPECT_TRUE(begin().world_from_head);
  EXPECT_TRUE(both_->paces_device());
  EXPECT_EQ(both_->take_actions({})[0], kPress);
  EXPECT_EQ(both_->take_mirror_actions({})[0], kOtherPress);
}

TEST_F(MirroredDisplayTest, EitherOfThemEndsTheRun) {
  window_->verdict = FrameVerdict::kQuit;
  EXPECT_EQ(begin().verdict, FrameVerdict::kQuit);
  EXPECT_THAT(headset_.ended, testing::ElementsAre(false));  // the frame that it had begun
  headset_.verdict = FrameVerdict::kQuit;
  EXPECT_EQ(begin().verdict, FrameVerdict::kQuit);
  EXPECT_EQ(headset_.ended.size(), 1u);
}

}  // namespace
}  // namespace neritic::xr
