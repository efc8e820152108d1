// A headset as a display, frame by frame without a dive: its buttons and panels.
#include <gmock/gmock.h>

#include <deque>

#include "tests/testbed/headset/headset_run.hpp"

namespace neritic::testbed {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class HeadsetDirect : public HeadsetRun {
 protected:
  void connect() {
    NERITIC_ASSERT_OK(
        headset_, xr::Headset::connect(
                      {.actions = {{"squeeze", xr::ActionKind::kPress, {"left trigger"}, ""}}}));
    gpu::DeviceOptions options;
    headset_->require(options);
    NERITIC_ASSERT_OK(device_, gpu::Device::create(options));
    NERITIC_ASSERT_STATUS(headset_->attach(*device_));
  }
  // The presses of a frame that shows nothing.
  double presses() {
    EXPECT_TRUE(headset_->begin_frame({}).ok());
    const double count = headset_->take_actions({})[0];
    EXPECT_TRUE(headset_->end_frame(false).ok());
    return count;
  }
  // A frame with panels of that size, or with their last pictures.
  void show(std::vector<const char*> names, bool pictures, bool submitted,
            std::uint32_t size = 32) {
    NERITIC_ASSERT_OK(const xr::DisplayFrame frame, headset_->begin_frame({}));
    ASSERT_EQ(frame.verdict, xr::FrameVerdict::kDraw);
    graph::FrameGraph graph;
    std::vector<xr::Layer> layers;
    for (const char* name : names) {
      xr::PanelLayer panel{.name = name, .pose = {{0.0, 0.0, -1.0}}};
      if (pictures) {
        NERITIC_ASSERT_OK(gpu::Image image,
                          gpu::Image::create(*device_, {.name = name,
                                                        .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                        .width = size,
                                                        .height = size,
                                                        .usage = VK_IMAGE_USAGE_SAMPLED_BIT}));
        panel.image = graph.import_image(images_.emplace_back(std::move(image)), {});
      }
      layers.push_back(panel);
    }
    ASSERT_TRUE(headset_->declare(graph, {}, layers).ok());
    NERITIC_ASSERT_STATUS(headset_->end_frame(submitted));
  }
  std::string last_line(fakes::FakeHeadset& fake) {
    std::string line, last;
    for (std::istringstream lines(fake.log()); std::getline(lines, line);) last = line;
    return last;
  }

  std::unique_ptr<gpu::Device> device_;  // outlives the headset
  std::deque<gpu::Image> images_;
  std::unique_ptr<xr::Headset> headset_;
};

// The button goes down while another program has the wearer, and is held until it is back.
TEST_F(HeadsetDirect, AButtonHeldWhenFocusReturnsIsNoPress) {
  fakes::FakeHeadset fake(
      "size 16 16\nperiod 0.1\nprofile both khr/simple_controller\n"
      "input /user/hand/left/input/select/click 0 0\n");
  connect();
  const auto button = [&](int value) {
    fake.write(fmt::format("input /user/hand/left/input/select/click {} {}\n", fake.now_s() + 0.01,
                           value));
  };
  for (int i = 0; i < 4; ++i) EXPECT_EQ(presses(), 0.0);
  button(1);
  EXPECT_EQ(presses() + presses(), 1.0);
  button(0);
  EXPECT_EQ(presses() + presses(), 0.0);
  fake.happen("visible");
  EXPECT_EQ(presses(), 0.0);
  button(1);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(presses(), 0.0);
  fake.happen("focused");
  for (int i = 0; i < 4; ++i) EXPECT_EQ(presses(), 0.0);
  button(0);
  EXPECT_EQ(presses() + presses(), 0.0);
  button(1);
  EXPECT_EQ(presses() + presses(), 1.0);
  // A controller that is switched off and on again with the button down.
  fake.happen("profile both none");
  EXPECT_EQ(presses() + presses(), 0.0);
  fake.happen("profile both khr/simple_controller");
  EXPECT_EQ(presses() + presses(), 0.0);
  headset_.reset();
}

// The runtime's image was not drawn: there is no last picture to show.
TEST_F(HeadsetDirect, APanelOfAFrameThatWasNotSubmittedHasNoPicture) {
  fakes::FakeHeadset fake("size 16 16\nviews 1\n");
  connect();
  for (int i = 0; i < 3; ++i) presses();
  show({"dial"}, true, false);
  show({"dial"}, false, true);
  EXPECT_THAT(last_line(fake), Not(HasSubstr("quad")));
  headset_.reset();
}

TEST_F(HeadsetDirect, LargePanelsAreShownCoarserAndTheLastOfTooManyAreLeftOut) {
  fakes::FakeHeadset fake("size 16 16\nviews 1\nmax_size 100\nmax_layers 2\n");
  connect();
  for (int i = 0; i < 3; ++i) presses();
  ::testing::internal::CaptureStderr();
  show({"dial", "map", "list"}, true, true, 300);
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, HasSubstr("panel dial of 300 x 300 pixels is shown coarser"));
  EXPECT_THAT(said, HasSubstr("shows 2 layers at most: without list"));
  EXPECT_THAT(last_line(fake), HasSubstr("quad quad"));
  EXPECT_THAT(last_line(fake), Not(HasSubstr("quad quad quad")));
  headset_.reset();
}

}  // namespace
}  // namespace neritic::testbed
