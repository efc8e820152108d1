// The processor's time for a stereo frame outside of the device's work: all that the rendering
// thread does, from the runtime's wait to its end of the frame, in the whole default dive.
#include <condition_variable>
#include <ctime>
#include <map>
#include <mutex>

#include "engine/core/random.hpp"
#include "engine/sim/step_clock.hpp"
#include "tests/testbed/headset/headset_run.hpp"

namespace neritic::testbed {
namespace {

constexpr double kDisplay_hz = 90.0;
// The instruments are drawn in one of this number of frames.
constexpr std::size_t kHudEvery = static_cast<std::size_t>(kDisplay_hz / kHudRate_hz);

// The yardstick's time where a frame takes 1.1 ms, as on one quiet core of an AMD EPYC; from their
// ratio on a virtual machine whose system calls take 1 us, where both take 1.9 times as long.
constexpr double kYardstick_ms = 0.12;

// Simulated time at the display's rate: so much passes with each frame, however long the device
// draws it. By the wall's clock a slow device would have instruments, which are drawn so many times
// a second of the dive, drawn in every frame.
class FrameClock final : public sim::StepClock {
 public:
  TimeNs now() override {
    const std::lock_guard lock(mutex_);
    return now_;
  }
  void wait_until(TimeNs time_ns) override {
    std::unique_lock lock(mutex_);
    passed_.wait_for(lock, std::chrono::milliseconds(2), [&] { return now_ >= time_ns; });
  }
  void pass_frame() {
    const std::lock_guard lock(mutex_);
    now_ += static_cast<TimeNs>(1e9 / kDisplay_hz);
    passed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable passed_;
  TimeNs now_ = 0;
};

// Notes what the thread has spent, once a frame.
class ThreadTime final : public SampleSource {
 public:
  explicit ThreadTime(FrameClock& clock) : clock_(clock) {}
  Status poll(SampleInbox&, double) override {
    const double before_ms = spent_ms();
    yardstick();
    const double now_ms = spent_ms();
    frames_.push_back({before_ms - since_ms_, now_ms - before_ms});
    since_ms_ = now_ms;
    clock_.pass_frame();
    return {};
  }
  // The mean of a frame over as many as follow one drawing of the instruments; a quarter of such
  // runs take less: what else the machine does slows the others. In the time of a core that takes
  // kYardstick_ms for the yardstick, which a neighbour on the same core slows alike.
  double frame_ms(std::size_t from) const {
    std::vector<double> runs;
    for (std::size_t i = from + kHudEvery; i < frames_.size(); ++i) {
      double frames_ms = 0.0, yardsticks_ms = 0.0;
      for (std::size_t k = i - kHudEvery + 1; k <= i; ++k) {
        frames_ms += frames_[k].frame_ms;
        yardsticks_ms += frames_[k].yardstick_ms;
      }
      runs.push_back(frames_ms / yardsticks_ms * kYardstick_ms);
    }
    std::ranges::sort(runs);
    return runs.empty() ? 1e9 : runs[runs.size() / 4];
  }

 private:
  struct Frame {
    double frame_ms, yardstick_ms;
  };
  static double spent_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }
  // A fixed work of the same kinds as a frame's: text, small memory, tables and system calls.
  void yardstick() {
    std::map<std::string, double> table;
    for (int i = 0; i < 160; ++i) {
      word_ = mix64(word_ + 1);
      table[fmt::format("stream {} of {}", word_ % 64, i % 7)] += 1e-3 * i;
      if (i % 4 == 0) spent_ms();
    }
    for (const auto& [name, value] : table) word_ += name.size() + (value > 0.1);
  }

  FrameClock& clock_;
  std::uint64_t word_ = 1;
  double since_ms_ = 0.0;
  std::vector<Frame> frames_;
};

using HeadsetCost = HeadsetRun;

// The aim is 1.5 ms. A Xeon in a virtual machine needs 1.6 to 1.8 in this yardstick beside
// neighbours that take its caches, and 2.3 to 2.5 alone, where the yardstick gains more than a
// frame does; the limit leaves room for both. A sixth of it is the bubbles, a sixth the snow, a
// sixth the fake runtime's strict checks. With the validation layers it is far more: they are off.
TEST_F(HeadsetCost, AStereoFrameOfTheWholeDiveTakesLittleOfOneCore) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "an instrumented build";
#endif
  fakes::FakeHeadset fake("size 16 16\nperiod 0.0111\n");
  without_layer();
  without_validation();
  const scene::Scene scene =
      scene::load_scene(test::source_dir() / "assets/scenes/dive.toml").value();
  FrameClock clock;
  const auto physics = LivePhysics::create(PhysicsWorld::create(scene).value(),
                                           {.pace = LivePhysics::Pace::kClock, .clock = &clock});
  ThreadTime spent(clock);
  with(*physics);
  with(spent);
  with(DiveHudOptions{.layouts = {hud::LayoutKind::kWrist}});
  NERITIC_ASSERT_STATUS(dive(scene, 60));
  RecordProperty("frame_ms", fmt::format("{:.3f}", spent.frame_ms(12)));
  EXPECT_LT(spent.frame_ms(12), 3.0);
}

// The same dive, of which the measurement leaves the layers out.
using HeadsetWholeDive = HeadsetRun;

TEST_F(HeadsetWholeDive, TheLayersHaveNothingToSay) {
  fakes::FakeHeadset fake("size 16 16\nperiod 0.0111\n");
  const scene::Scene scene =
      scene::load_scene(test::source_dir() / "assets/scenes/dive.toml").value();
  NERITIC_ASSERT_OK(const auto physics, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
  with(*physics);
  with(DiveHudOptions{.layouts = {hud::LayoutKind::kWrist}});
  NERITIC_ASSERT_STATUS(dive(scene, 10));
}

}  // namespace
}  // namespace neritic::testbed
