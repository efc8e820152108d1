// A scene with a diver that is rendered, or shown without instruments, panels and headset, has none
// of their passes, memory or threads; with them it has.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/xr/desktop/overlay.hpp"
#include "engine/xr/offscreen.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/view/dive_camera.hpp"
#include "testbed/view/dive_view.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/simulation/devices.hpp"

namespace neritic::testbed {
namespace {

std::size_t threads() {
  std::size_t count = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    (void)task;
    ++count;
  }
  return count;
}

class NothingUnasked : public test::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    scene_ = dive_of(hover_text("") + "[sun]\n").scene;
    scene_.cameras.push_back(camera_for(scene_));
    scene_.cameras[0].width = 96, scene_.cameras[0].height = 54;
    NERITIC_ASSERT_OK(session_, Session::create(device(), scene_));
    session_->keep_plan_dump(true);
    NERITIC_ASSERT_OK(physics_, LivePhysics::create(scene_, LivePhysics::Pace::kPicture));
    NERITIC_ASSERT_OK(
        display_, xr::OffscreenDisplay::create(device(), {.groups = {xr::one_view(96, 54, 1.0)}}));
    // The driver's own threads, pipelines, and what each frame in flight keeps are there then.
    for (int i = 0; i < 5; ++i) (void)render();
    memory_ = used();
  }
  void TearDown() override {
    physics_.reset(), display_.reset(), session_.reset();
    GpuTest::TearDown();
  }
  VkDeviceSize used() { return device().allocator().statistics().used_bytes; }
  std::string render() {
    FrameRequest request;
    request.cameras = {0};
    request.capture = kColorOnGpu;
    request.capture.to_host = true;
    const auto result = session_->render(request);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return session_->plan_text();
  }
  // The names of the passes of some frames; then: while the view is there.
  std::string show(DiveViewOptions options, xr::Overlay* overlay,
                   const std::function<void()>& then) {
    options.summary = true;
    auto made = DiveView::create(*session_, *display_, overlay, physics_.get(), options);
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
    const std::unique_ptr<DiveView> view = std::move(*made);
    Loop loop(
        {.clock = Clock::simulated(0.0, 1.0 / 4.0),
         .physics = physics_.get(),
         .sensors =
             LoopSensors{.session = session_.get(), .capture = kColorOnGpu, .own_rates = true},
         .view = view.get(),
         .stop = {.frames = 4}});
    EXPECT_TRUE(loop.run().ok());
    then();
    std::string names;
    for (const TimeRow& row : view->times().passes()) names += row.name + "\n";
    return names;
  }
  static void expect_none(const std::string& plan) {
    ASSERT_NE(plan.find("gbuffer"), std::string::npos) << plan;
    for (const char* word : {"hud", "overlay", "panel", "present", "headset", "hidden", "pick"})
      EXPECT_EQ(plan.find(word), std::string::npos) << word << " in\n" << plan;
  }

  scene::Scene scene_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<LivePhysics> physics_;
  std::unique_ptr<xr::Display> display_;
  VkDeviceSize memory_ = 0;
};

TEST_F(NothingUnasked, NeitherPassesNorMemoryNorThreadsOfWhatASceneIsNotShownWith) {
  const std::size_t before = threads();
  expect_none(render());
  EXPECT_EQ(used(), memory_);
  EXPECT_EQ(threads(), before);
  VkDeviceSize bare = 0;
  expect_none(show({}, nullptr, [&] {
    bare = used();
    EXPECT_EQ(threads(), before);
  }));

  // Otherwise the test could not fail.
  const DiveHudOptions hud{.layouts = {hud::LayoutKind::kCorner}};
  const std::string with_hud = show({.hud = hud}, nullptr, [&] { EXPECT_GT(used(), bare); });
  EXPECT_NE(with_hud.find("hud"), std::string::npos) << with_hud;
  NERITIC_ASSERT_OK(const auto overlay, xr::Overlay::create(device(), nullptr, 1.0f));
  const std::string with_panels = show({}, overlay.get(), [&] { EXPECT_GT(used(), bare); });
  EXPECT_NE(with_panels.find("overlay"), std::string::npos) << with_panels;
}

// The console of a scene without a vehicle draws no picture of a sensor for it.
TEST_F(NothingUnasked, TheInstrumentsConsoleOfASceneWithoutAVehicleDrawsNoSensorForItself) {
  const DiveHudOptions hud{.layouts = {hud::LayoutKind::kConsole}};
  const std::string names = show({.hud = hud}, nullptr, [] {});
  EXPECT_NE(names.find("hud console"), std::string::npos) << names;
  for (const char* word : {"hud camera", "hud sonar", "fan"})
    EXPECT_EQ(names.find(word), std::string::npos) << word << " in\n" << names;
}

}  // namespace
}  // namespace neritic::testbed
