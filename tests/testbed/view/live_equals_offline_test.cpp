// One scene in two configurations of the loop, on a simulated clock: a window's, with panels or a
// headset that is taken off for a while, and `render`'s. The sonar hears the same bits, Doppler and
// motion within the ping included, and the log has the same rows.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/xr/desktop/overlay.hpp"
#include "engine/xr/offscreen.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/record/file_sinks.hpp"
#include "testbed/view/dive_view.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/csv_text.hpp"
#include "tests/testbed/wall_flight.hpp"
#include "tests/xr/fake_headset.hpp"

namespace neritic::testbed {
namespace {

constexpr double kFrames_hz = 64.0, kPings_hz = 4.0;
constexpr std::uint64_t kFrames = 129, kPings = 9;  // both end at 2 s

class Pings final : public FrameSink {
 public:
  Status accept(const FrameResult& frame) override {
    EXPECT_EQ(frame.sonars.size(), 1u);
    frames.push_back(frame.frame);
    times_s.push_back(frame.time_s);
    sonars.push_back(frame.sonars.front());
    return {};
  }
  Status finish() override {
    ++finished;
    return {};
  }
  std::vector<std::uint32_t> frames;
  std::vector<double> times_s;
  std::vector<SonarFrame> sonars;
  int finished = 0;
};

class LiveEqualsOffline : public test::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    scene_ = scene_of_flight();
    NERITIC_ASSERT_OK(session_, Session::create(device(), scene_));
  }

  struct Outcome {
    Pings pings;
    std::string csv;
    std::uint64_t frames = 0;
  };
  // A run of the loop with a log and the sink of pings; the rest is the configuration's.
  Outcome run(LivePhysics& physics, LoopParts parts) {
    Outcome out;
    std::vector<std::unique_ptr<RowSink>> text;
    text.push_back(std::make_unique<CsvText>(physics.world(), out.csv));
    DiveLog log(physics.world(), 0.0, std::move(text));
    parts.physics = &physics;
    parts.step_sinks = {&log};
    parts.frame_sinks = {&out.pings};
    Loop loop(std::move(parts));
    const Status status = loop.run();
    EXPECT_TRUE(status.ok()) << status.error().message;
    out.frames = loop.frames();
    return out;
  }
  LoopSensors sonar(bool own_rates) const {
    return {.session = session_.get(), .sonars = {0}, .own_rates = own_rates};
  }
  Outcome rendered() {
    const auto physics = LivePhysics::create(scene_, LivePhysics::Pace::kPicture).value();
    return run(*physics, {.clock = Clock::simulated(0.0, 1.0 / kPings_hz),
                          .sensors = sonar(false),
                          .stop = {.frames = kPings}});
  }
  Outcome shown(xr::Display& display, xr::Overlay* overlay, std::uint64_t frames) {
    const auto physics = LivePhysics::create(scene_, LivePhysics::Pace::kPicture).value();
    const auto view =
        DiveView::create(*session_, display, overlay, physics.get(), {.sonars = {0}}).value();
    return run(*physics, {.clock = Clock::simulated(0.0, 1.0 / kFrames_hz),
                          .sensors = sonar(true),
                          .view = view.get(),
                          .sources = {&view->pilot()},
                          .stop = {.frames = frames}});
  }
  static void expect_same(const Outcome& live, const Outcome& offline) {
    EXPECT_EQ(live.csv, offline.csv);
    EXPECT_EQ(std::ranges::count(live.csv, '\n'), 102);  // 50 a second, the start, the heading
    EXPECT_EQ(live.pings.frames, offline.pings.frames);
    EXPECT_EQ(live.pings.times_s, offline.pings.times_s);
    ASSERT_EQ(live.pings.sonars.size(), kPings);
    ASSERT_EQ(offline.pings.sonars.size(), kPings);
    EXPECT_EQ(live.pings.finished, 1);
    for (std::size_t i = 0; i < kPings; ++i) {
      const SonarFrame &a = live.pings.sonars[i], &b = offline.pings.sonars[i];
      EXPECT_EQ(a.image.intensity, b.image.intensity) << i;
      EXPECT_EQ(a.image.labels, b.image.labels) << i;
      EXPECT_EQ(a.world_from_sonar.position_m, b.world_from_sonar.position_m) << i;
      EXPECT_EQ(a.sectors.front().depth.data, b.sectors.front().depth.data) << i;
    }
    // It is no comparison of silence, nor of one picture with itself.
    const auto heard = [](const SonarFrame& ping) {
      return std::ranges::any_of(ping.image.intensity, [](float i) { return i > 0.0f; });
    };
    EXPECT_GE(std::ranges::count_if(live.pings.sonars, heard), 4);
    EXPECT_TRUE(heard(live.pings.sonars[1]));
    EXPECT_NE(live.pings.sonars[1].image.intensity, live.pings.sonars[2].image.intensity);
  }

  scene::Scene scene_;
  std::unique_ptr<Session> session_;
};

TEST_F(LiveEqualsOffline, AWindowWithPanelsAndRenderGiveTheSameSonarAndLog) {
  NERITIC_ASSERT_OK(const auto display, xr::OffscreenDisplay::create(
                                            device(), {.groups = {xr::one_view(96, 54, 1.0)}}));
  NERITIC_ASSERT_OK(const auto overlay, xr::Overlay::create(device(), nullptr, 1.0f));
  const Outcome live = shown(*display, overlay.get(), kFrames);
  EXPECT_EQ(live.frames, kFrames);
  expect_same(live, rendered());
}

// Nobody looks from 0.3 s to 1.6 s.
TEST_F(LiveEqualsOffline, WhileTheViewIsHiddenSonarAndLogGoOn) {
  const auto worn = [](std::uint64_t frame) { return frame < 20 || frame >= 100; };
  NERITIC_ASSERT_OK(
      const auto headset,
      xr::FakeHeadset::create(device(), {.groups = {xr::eye_pair(32, 32)},
                                         .stage_from_head = [](std::uint64_t) { return Pose{}; },
                                         .worn = worn}));
  const Outcome live = shown(*headset, nullptr, kFrames - 80);
  EXPECT_EQ(headset->ended().size(), kFrames);
  expect_same(live, rendered());
}

// The flown camera, the display and a riding sonar leave the scene as it was loaded.
TEST_F(LiveEqualsOffline, ARunLeavesTheSceneAsItIs) {
  NERITIC_ASSERT_OK(const auto display, xr::OffscreenDisplay::create(
                                            device(), {.groups = {xr::one_view(40, 30, 1.0)}}));
  (void)shown(*display, nullptr, 20);
  const scene::Camera &after = session_->scene().cameras[0], &before = scene_.cameras[0];
  EXPECT_EQ(after.width, before.width);
  EXPECT_EQ(after.height, before.height);
  EXPECT_EQ(after.mount.object, before.mount.object);
  EXPECT_EQ(after.mount.pose.position_m, before.mount.pose.position_m);
  for (std::size_t i = 0; i < scene_.objects.size(); ++i)
    EXPECT_EQ(session_->scene().objects[i].mount.pose.position_m,
              scene_.objects[i].mount.pose.position_m);
}

// A sonar that no panel, sink or flag names has no pass.
TEST_F(LiveEqualsOffline, ASonarThatNobodyWantsIsNotDeclared) {
  NERITIC_ASSERT_OK(const auto display, xr::OffscreenDisplay::create(
                                            device(), {.groups = {xr::one_view(40, 30, 1.0)}}));
  for (const bool wanted : {false, true}) {
    NERITIC_ASSERT_OK(const auto view,
                      DiveView::create(*session_, *display, nullptr, nullptr, {.summary = true}));
    LoopSensors sensors{.session = session_.get(), .capture = kColorOnGpu, .own_rates = true};
    if (wanted) sensors.sonars = {0};
    Loop loop({.clock = Clock::simulated(0.0, 1.0 / kFrames_hz),
               .sensors = sensors,
               .view = view.get(),
               .stop = {.frames = 4}});
    NERITIC_ASSERT_STATUS(loop.run());
    bool sonar_ran = false;
    for (const TimeRow& row : view->times().passes())
      sonar_ran |= row.name.find("sonar") != std::string::npos;
    EXPECT_EQ(sonar_ran, wanted);
  }
}

}  // namespace
}  // namespace neritic::testbed
