// The processor's time for a stereo frame outside of the device's work: all that the rendering
// thread does, from the runtime's wait to its end of the frame, in the whole default dive.
#include <condition_variable>
#include <map>
#include <mutex>

#include "engine/core/random.hpp"
#include "engine/sim/step_clock.hpp"
#include "tests/testbed/headset/driver_time.hpp"
#include "tests/testbed/headset/headset_run.hpp"

namespace neritic::testbed {
namespace {

constexpr double kDisplay_hz = 90.0;
// The instruments are drawn in one of this number of frames.
constexpr std::size_t kHudEvery = static_cast<std::size_t>(kDisplay_hz / kHudRate_hz);

// The yardstick's time where a frame takes 1.1 ms, as on one quiet core of an AMD EPYC; from their
// ratio on a virtual machine whose system calls take 1 us, where both take 1.9 times as long.
constexpr double kYardstick_ms = 0.12;

// The driver's time is counted in so many frames after so many plain ones.
constexpr std::size_t kPlainFrames = 60, kCountedFrames = 36;

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
  // Of a frame, ms: all that the thread does; of it what it does in the fake runtime, which checks
  // each call, and, once that is counted, in the driver.
  struct Frame {
    double all = 0.0, in_runtime = 0.0, in_driver = 0.0;
  };

  ThreadTime(FrameClock& clock, fakes::FakeHeadset& headset) : clock_(clock), headset_(headset) {}
  Status poll(SampleInbox&, double) override {
    const Spent now{spent_ms(), headset_.spent_ms(), DriverTime::spent_ms()};
    DriverTime::count(frames_.size() + 1 >= kPlainFrames);
    yardstick();
    const double after_ms = spent_ms();
    frames_.push_back({{now.all - since_.all, now.in_runtime - since_.in_runtime,
                        now.in_driver - since_.in_driver},
                       after_ms - now.all});
    since_ = now;
    since_.all = after_ms;
    clock_.pass_frame();
    return {};
  }
  // Of the frames before the driver's time is counted, or of those in which it is.
  template <typename Part>
  double plain_ms(const Part& part) const {
    return frame_ms(12, kPlainFrames, part);
  }
  template <typename Part>
  double counted_ms(const Part& part) const {
    return frame_ms(kPlainFrames, frames_.size(), part);
  }

 private:
  // The mean of a frame over as many as follow one drawing of the instruments; a quarter of such
  // runs take less, by what is given of a frame: what else the machine does slows the others. In
  // the time of a core that takes kYardstick_ms for the yardstick, which a neighbour on the same
  // core slows alike.
  template <typename Part>
  double frame_ms(std::size_t from, std::size_t end, const Part& part) const {
    std::vector<double> runs;
    for (std::size_t i = from + kHudEvery; i < end; ++i) {
      double frames_ms = 0.0, yardsticks_ms = 0.0;
      for (std::size_t k = i - kHudEvery + 1; k <= i; ++k) {
        frames_ms += part(frames_[k].frame);
        yardsticks_ms += frames_[k].yardstick_ms;
      }
      runs.push_back(frames_ms / yardsticks_ms * kYardstick_ms);
    }
    std::ranges::sort(runs);
    return runs.empty() ? 1e9 : runs[runs.size() / 4];
  }

  using Spent = Frame;
  struct Timed {
    Frame frame;
    double yardstick_ms;
  };
  static double spent_ms() { return to_ms(DriverTime::thread_ns()); }
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
  fakes::FakeHeadset& headset_;
  Spent since_;
  std::vector<Timed> frames_;
};

using HeadsetCost = HeadsetRun;

// The aim is 1.5 ms of what the program and its driver do; the runtime here is a fake, whose strict
// checks are no part of it. A Xeon in a virtual machine needs 1.3 to 1.4 in this yardstick, 0.3 of
// it in Mesa's software driver, and the fake 0.3 more; the limit leaves room for neighbours that
// take its caches. With the validation layers it is far more: they are off.
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
  ThreadTime spent(clock, fake);
  with(*physics);
  with(spent);
  with(DiveHudOptions{.layouts = {hud::LayoutKind::kWrist}});
  once_device_is_made(DriverTime::begin);
  NERITIC_ASSERT_STATUS(dive(scene, kPlainFrames + kCountedFrames));
  using Frame = ThreadTime::Frame;
  const double all_ms = spent.plain_ms([](const Frame& f) { return f.all; });
  const double frame_ms = spent.plain_ms([](const Frame& f) { return f.all - f.in_runtime; });
  const double driver_ms = spent.counted_ms([](const Frame& f) { return f.in_driver; });
  RecordProperty("all_ms", fmt::format("{:.3f}", all_ms));
  RecordProperty("frame_ms", fmt::format("{:.3f}", frame_ms));
  RecordProperty("in_driver_ms", fmt::format("{:.3f}", driver_ms));
  // 1.65 on an idle core, less beside other programs, which slow the yardstick more.
  EXPECT_LT(frame_ms, 2.1);
  // Both parts were counted.
  EXPECT_LT(frame_ms, all_ms);
  EXPECT_GT(driver_ms, 0.0);
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
