// A scene through the seam as a headset sees it: a stereo pair and four views, each drawn with its
// own pose, tangents and size, with depth, and with a device that the display made.
#include <gtest/gtest.h>

#include "engine/render/lighting.hpp"
#include "engine/render/renderer.hpp"
#include "tests/xr/ball_scene.hpp"

namespace neritic::xr {
namespace {

class HeadsetTest : public test::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    scene_ = ball_scene();
    NERITIC_ASSERT_OK(renderer_, render::Renderer::create(device()));
    NERITIC_ASSERT_OK(gpu_scene_,
                      render::GpuScene::create(device(), scene_, renderer_->material_layout()));
  }

  // Declares the views of a group and gives its layer. Objects that the passes borrow live until
  // the next frame.
  ProjectionLayer draw(graph::FrameGraph& graph, const DisplayFrame& frame, std::size_t index) {
    const ViewGroup& group = frame.groups[index];
    auto drawn = std::make_unique<Drawn>();
    drawn->state = render::evaluate_frame(scene_, *gpu_scene_, 0.0, 0.0, false);
    drawn->views.width = group.width;
    drawn->views.height = group.height;
    for (const View& view : group.views) {
      const Pose pose = *frame.world_from_head * view.head_from_view;
      drawn->views.views.push_back({pose, view.tangents, kNear_m, 0.0, pose});
    }
    drawn->draws = render::build_draw_list(scene_, *gpu_scene_, drawn->state, drawn->views);
    const std::string prefix = fmt::format("group {} ", index);
    const auto deformed = renderer_->declare_deform(graph, *gpu_scene_, drawn->state).value();
    const auto g = renderer_
                       ->declare_gbuffer(graph, prefix, render::GBufferKind::kSurface, *gpu_scene_,
                                         drawn->state, deformed, drawn->views, drawn->draws)
                       .value();
    drawn->lighting = render::make_lighting(scene_, drawn->state, drawn->views.origin_m(), {},
                                            gpu_scene_->has_emission())
                          .value();
    const auto hdr =
        renderer_->declare_shade(graph, prefix, {g, drawn->views, drawn->lighting}).value();
    const auto picture = renderer_
                             ->declare_picture(graph, prefix, hdr, group.width, group.height,
                                               drawn->views.layers(), false)
                             .value();
    drawn_.push_back(std::move(drawn));
    return {index, picture, g.depth, kNear_m};
  }

  // One frame of all groups on a headset.
  void show(FakeHeadset& headset, DisplayFrame& frame) {
    NERITIC_ASSERT_OK(frame, headset.begin_frame(kStage));
    graph::FrameGraph graph;
    std::vector<Layer> layers;
    for (std::size_t i = 0; i < frame.groups.size(); ++i) layers.push_back(draw(graph, frame, i));
    NERITIC_ASSERT_OK(const ShownPicture shown,
                      headset.declare(graph, *frame.world_from_head, layers));
    EXPECT_EQ(shown.width, frame.groups[0].width);
    run_and_read(device(), graph, headset.color(0));
    NERITIC_ASSERT_STATUS(headset.end_frame(true));
    drawn_.clear();
  }

 private:
  struct Drawn {
    render::FrameState state;
    render::ViewSet views;
    render::DrawList draws;
    shared::Lighting lighting;
  };
  scene::Scene scene_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::GpuScene> gpu_scene_;
  std::vector<std::unique_ptr<Drawn>> drawn_;
};

TEST_F(HeadsetTest, AStereoPairIsDrawnFromTheTrackedHeadWithItsOwnTangents) {
  NERITIC_ASSERT_OK(const auto headset,
                    FakeHeadset::create(device(), {{eye_pair(120, 110)}, head_at, {}}));
  for (int i = 0; i < 2; ++i) {
    DisplayFrame frame;
    show(*headset, frame);
    const Pose expected = kStage * head_at(static_cast<std::uint64_t>(i));
    ASSERT_TRUE(frame.world_from_head);
    EXPECT_LT(glm::distance(frame.world_from_head->position_m, expected.position_m), 1e-12);
    expect_ball(device(), *headset, *frame.world_from_head, frame.groups[0], 0);
    EXPECT_EQ(headset->ended().back().projections, (std::vector<std::size_t>{0}));
    EXPECT_EQ(headset->ended().back().with_depth, (std::vector<bool>{true}));
  }
}

TEST_F(HeadsetTest, FourViewsAreTwoGroupsOfTheirOwnSizes) {
  // The inner pair sees a quarter of the angle with as many pixels.
  NERITIC_ASSERT_OK(
      const auto headset,
      FakeHeadset::create(device(), {{eye_pair(100, 90), eye_pair(140, 130, 0.25)}, head_at, {}}));
  DisplayFrame frame;
  show(*headset, frame);
  expect_ball(device(), *headset, *frame.world_from_head, frame.groups[0], 0);
  expect_ball(device(), *headset, *frame.world_from_head, frame.groups[1], 1);
  EXPECT_EQ(headset->ended().back().projections, (std::vector<std::size_t>{0, 1}));
}

TEST_F(HeadsetTest, AFrameThatNobodySeesEndsWithoutLayers) {
  NERITIC_ASSERT_OK(
      const auto headset,
      FakeHeadset::create(device(), {{eye_pair(16, 16)}, head_at, [](std::uint64_t frame) {
                                       return frame % 2 == 1;
                                     }}));
  NERITIC_ASSERT_OK(const DisplayFrame hidden, headset->begin_frame({}));
  EXPECT_EQ(hidden.verdict, FrameVerdict::kHidden);
  NERITIC_ASSERT_STATUS(headset->end_frame(false));
  NERITIC_ASSERT_OK(const DisplayFrame seen, headset->begin_frame({}));
  EXPECT_EQ(seen.verdict, FrameVerdict::kDraw);
  EXPECT_EQ(*seen.display_at_ns - *hidden.display_at_ns, FakeHeadset::Options{}.period_ns);
  EXPECT_TRUE(headset->ended()[0].projections.empty());
}

TEST_F(HeadsetTest, TheDisplayMakesInstanceAndDevice) {
  int calls = 0;
  gpu::ValidationLog messages;
  gpu::DeviceOptions options;
  options.validation = true;
  options.validation_sink = &messages;
  FakeHeadset::require(options, calls);
  {
    NERITIC_ASSERT_OK(const auto made, gpu::Device::create(options));
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(made->info().index, 0u);
    NERITIC_ASSERT_OK(const auto image,
                      gpu::Image::create(*made, {.name = "one",
                                                 .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT}));
  }
  for (const std::string& message : messages.messages) ADD_FAILURE() << message;
}

TEST_F(HeadsetTest, AnExtensionThatTheDisplayNeedsAndTheDeviceLacksIsNamed) {
  gpu::DeviceOptions options;
  options.device_extensions = {"VK_EXT_not_there"};
  const auto made = gpu::Device::create(options);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(made.error().message.find("VK_EXT_not_there"), std::string::npos);
}

}  // namespace
}  // namespace neritic::xr
