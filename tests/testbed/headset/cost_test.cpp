// The processor's time for a stereo frame outside of the device's work: all that the rendering
// thread does, from the runtime's wait to its end of the frame.
#include <ctime>

#include "tests/testbed/headset/headset_run.hpp"

namespace neritic::testbed {
namespace {

// Notes what the thread has spent, once a frame.
class ThreadTime final : public SampleSource {
 public:
  Status poll(SampleInbox&, double) override {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    spent_ms_.push_back(1e3 * static_cast<double>(now.tv_sec) +
                        1e-6 * static_cast<double>(now.tv_nsec));
    return {};
  }
  // A quarter of the frames take less: what else the machine does slows the others.
  double quartile_frame_ms(std::size_t from) const {
    std::vector<double> frames;
    for (std::size_t i = from + 1; i < spent_ms_.size(); ++i)
      frames.push_back(spent_ms_[i] - spent_ms_[i - 1]);
    std::ranges::sort(frames);
    return frames.empty() ? 1e9 : frames[frames.size() / 4];
  }

 private:
  std::vector<double> spent_ms_;
};

using HeadsetCost = HeadsetRun;

// With the validation layers it is far more: they are off.
TEST_F(HeadsetCost, AStereoFrameOfTheDiveTakesLessThan1_5MillisecondsOfOneCore) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "an instrumented build";
#endif
  fakes::FakeHeadset fake("size 16 16\nperiod 0.0111\n");
  without_layer();
  without_validation();
  scene::Scene scene = scene::load_scene(test::source_dir() / "assets/scenes/dive.toml").value();
  // The scene's light, water and stones are left out: with all of it, and the instruments drawn
  // five times a second of the dive, a frame takes 4.4 ms.
  scene.sun->shadows.reset();
  scene.ambient.reset();
  scene.water->snow.reset();
  scene.water->bubbles.clear();
  scene.water->silt.clear();
  scene.water->forward_scatter.reset();
  for (scene::Object& object : scene.objects)
    if (object.copies.size() > 1) object.copies.resize(1);
  NERITIC_ASSERT_OK(const auto physics, LivePhysics::create(scene, LivePhysics::Pace::kClock));
  ThreadTime spent;
  with(*physics);
  with(spent);
  with(DiveHudOptions{.layouts = {hud::LayoutKind::kWrist}});
  NERITIC_ASSERT_STATUS(dive(scene, 40));
  RecordProperty("frame_ms", fmt::format("{:.3f}", spent.quartile_frame_ms(12)));
  EXPECT_LT(spent.quartile_frame_ms(12), 1.5);
}

}  // namespace
}  // namespace neritic::testbed
