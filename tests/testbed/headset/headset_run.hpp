// A dive on the fake OpenXR runtime (tests/fakes), as `neritic dive` runs it: headset, device that
// the runtime makes, session, view, loop; with the validation of Vulkan and, where it is installed,
// of OpenXR, whose messages fail the test.
#pragma once

#include "engine/scene/image_file.hpp"
#include "engine/xr/openxr/headset.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/view/dive_view.hpp"
#include "tests/fakes/core_validation.hpp"
#include "tests/fakes/fake_headset.hpp"
#include "tests/support/device_gate.hpp"
#include "tests/xr/ball_scene.hpp"

namespace neritic::testbed {

class HeadsetRun : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  }
  void TearDown() override {
    for (const std::string& message : vulkan_.messages) ADD_FAILURE() << message;
    for (const std::string& message : openxr_) ADD_FAILURE() << message;
  }
  // So many frames that are shown; 0: until the runtime ends it.
  Status dive(const scene::Scene& scene, std::uint64_t frames) {
    std::unique_ptr<gpu::Device> device;  // outlives the headset
    NERITIC_TRY(const auto headset,
                xr::Headset::connect({.room = scene.world_from_lab.has_value(),
                                      .refresh_hz = refresh_hz_,
                                      .actions = dive_actions(),
                                      .validation = layer_ && fakes::CoreValidation::installed()}));
    gpu::DeviceOptions options;
    options.validation = validation_;
    options.validation_sink = &vulkan_;
    headset->require(options);
    NERITIC_TRY(device, gpu::Device::create(options));
    if (device_made_) device_made_();
    const Status status = dive_on(*headset, *device, scene, frames);
    for (const std::string& message : headset->validation_messages()) openxr_.push_back(message);
    return status;
  }
  // For a test that measures time.
  void without_layer() { layer_ = false; }
  void without_validation() { validation_ = false; }
  // Called before anything is drawn.
  void once_device_is_made(std::function<void()> then) { device_made_ = std::move(then); }
  void ask_for_rate(double hz) { refresh_hz_ = hz; }
  // In lock-step with the pictures; outlives the dive.
  void with(LivePhysics& physics) { physics_ = &physics; }
  void with(DiveHudOptions hud) { hud_ = std::move(hud); }
  // Polled once a frame, on the rendering thread.
  void with(SampleSource& source) { source_ = &source; }
  // Ends the dive by time, shown or not.
  void end_after(double seconds) { seconds_ = seconds; }
  const std::string& folder() const { return folder_text_; }
  // A frame's view as the wearer saw it.
  ImageU8 picture(int frame, int view) const {
    return scene::read_image8(fmt::format("{}/frame_{:04}_view_{}.png", folder_text_, frame, view))
        .value();
  }
  std::uint64_t shown() const { return shown_; }
  // Its quality gives way where frames take longer than budget_ms, as it was in the last frame.
  void govern() { governed_ = true; }
  double budget_ms() const { return budget_ms_; }

 private:
  Status dive_on(xr::Headset& headset, gpu::Device& device, const scene::Scene& scene,
                 std::uint64_t frames) {
    NERITIC_TRY_STATUS(headset.attach(device));
    NERITIC_TRY(const auto session, Session::create(device, scene));
    NERITIC_TRY(const auto view, DiveView::create(*session, headset, nullptr, physics_,
                                                  {.hud = hud_, .governed = governed_}));
    std::vector<SampleSource*> sources;
    if (view->wearer()) sources.push_back(view->wearer());
    if (source_) sources.push_back(source_);
    const TimeNs end_ns = now_ns() + 250'000'000'000;
    Loop loop({.clock = Clock::real(0.0, 1.0 / 90.0),
               .physics = physics_,
               .sensors = LoopSensors{.session = session.get()},
               .view = view.get(),
               .sources = sources,
               .stop = {.frames = frames, .seconds = seconds_, .interrupted = [&] {
                          return now_ns() > end_ns;
                        }}});
    const Status status = loop.run();
    shown_ = loop.frames();
    budget_ms_ = view->budget_ms();
    if (loop.interrupted()) return failure(ErrorCode::kInterrupted, "it did not end");
    return status;
  }

  test::ScratchFolder scratch_;
  std::string folder_text_ = (scratch_ / "").string();
  gpu::ValidationLog vulkan_;
  std::vector<std::string> openxr_;
  std::uint64_t shown_ = 0;
  double budget_ms_ = 0.0;
  LivePhysics* physics_ = nullptr;
  std::optional<DiveHudOptions> hud_;
  SampleSource* source_ = nullptr;
  std::function<void()> device_made_;
  double seconds_ = 0.0, refresh_hz_ = 0.0;
  bool layer_ = true, validation_ = true, governed_ = false;
};

}  // namespace neritic::testbed
