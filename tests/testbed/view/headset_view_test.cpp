// The loop with a headset: every view of every group is drawn from the tracked head with its own
// pose, tangents and size, and its depth comes along.
#include <gtest/gtest.h>

#include "testbed/loop/loop.hpp"
#include "testbed/view/dive_view.hpp"
#include "tests/xr/ball_scene.hpp"

namespace neritic::testbed {
namespace {

class HeadsetView : public test::GpuTest {
 protected:
  // The program's camera is where the stage lies in the world.
  static scene::Scene scene() {
    scene::Scene scene = xr::ball_scene("[[cameras]]\nname = \"eyes\"\nwidth = 33\nheight = 22\n");
    scene.cameras[0].mount.pose = xr::kStage;
    scene.cameras[0].near_m = xr::kNear_m;
    return scene;
  }
  // Three frames of the loop; the last one's views are looked at.
  void expect_all_views(const std::vector<xr::ViewGroup>& groups) {
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene()));
    NERITIC_ASSERT_OK(const auto headset,
                      xr::FakeHeadset::create(device(), {groups, xr::head_at, {}}));
    NERITIC_ASSERT_OK(const auto view, DiveView::create(*session, *headset, nullptr, nullptr, {}));
    Loop loop({.clock = Clock::real(0.0, 1.0 / 90.0),
               .sensors = LoopSensors{.session = session.get()},
               .view = view.get(),
               .stop = {.frames = 3}});
    NERITIC_ASSERT_STATUS(loop.run());
    ASSERT_EQ(headset->ended().size(), 3u);
    const auto& ended = headset->ended().back();
    ASSERT_EQ(ended.projections.size(), groups.size());
    const Pose head = xr::kStage * xr::head_at(2);
    EXPECT_LT(glm::distance(ended.world_from_head.position_m, head.position_m), 1e-9);
    for (std::size_t i = 0; i < groups.size(); ++i) {
      EXPECT_EQ(ended.projections[i], i);
      EXPECT_TRUE(ended.with_depth[i]);
      xr::expect_ball(device(), *headset, head, groups[i], i);
    }
    EXPECT_EQ(session->scene().cameras[0].width, 33u);
  }
};

// A runtime waits for the end of each frame that it began.
TEST_F(HeadsetView, AFrameThatAStopCutsShortIsEnded) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene()));
  NERITIC_ASSERT_OK(const auto headset,
                    xr::FakeHeadset::create(device(), {{xr::eye_pair(12, 11)}, xr::head_at, {}}));
  NERITIC_ASSERT_OK(const auto view, DiveView::create(*session, *headset, nullptr, nullptr, {}));
  int asked = 0;
  Loop loop({.clock = Clock::real(0.0, 1.0 / 90.0),
             .sensors = LoopSensors{.session = session.get()},
             .view = view.get(),
             .stop = {.interrupted = [&] { return ++asked == 2; }}});  // within the first frame
  NERITIC_ASSERT_STATUS(loop.run());
  EXPECT_TRUE(loop.interrupted());
  EXPECT_EQ(headset->begun_frames(), 1u);
  EXPECT_EQ(headset->ended().size(), 1u);
}

// Two frames are in flight then; the view goes before the session.
TEST_F(HeadsetView, AFrameThatFailsIsEndedAndTheViewWaitsForThoseInFlight) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene()));
  NERITIC_ASSERT_OK(const auto headset,
                    xr::FakeHeadset::create(device(), {.groups = {xr::eye_pair(120, 110)},
                                                       .stage_from_head = xr::head_at,
                                                       .worn = {},
                                                       .fails_at = 2}));
  NERITIC_ASSERT_OK(auto view, DiveView::create(*session, *headset, nullptr, nullptr, {}));
  Loop loop({.clock = Clock::real(0.0, 1.0 / 90.0),
             .sensors = LoopSensors{.session = session.get()},
             .view = view.get(),
             .stop = {.frames = 5}});
  const Status status = loop.run();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "unplugged");
  EXPECT_EQ(headset->begun_frames(), 3u);
  EXPECT_EQ(headset->ended().size(), 3u);
  view.reset();
  NERITIC_ASSERT_OK(const std::uint64_t completed, session->frames().completed());
  EXPECT_GE(completed, 2u);
}

// A runtime that halves its rate, since frames were late, gives no longer budget.
TEST_F(HeadsetView, TheBudgetIsTheShortestPeriodThatTheDisplayTold) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene()));
  constexpr TimeNs kTold_ns[] = {12'500'000, 12'500'000, 25'000'000, 8'000'000, 12'500'000};
  constexpr double kBudget_ms[] = {12.5, 12.5, 12.5, 8.0, 8.0};
  NERITIC_ASSERT_OK(const auto headset,
                    xr::FakeHeadset::create(device(), {.groups = {xr::eye_pair(12, 11)},
                                                       .stage_from_head = xr::head_at,
                                                       .worn = {},
                                                       .told_period_ns = [&](std::uint64_t i) {
                                                         return kTold_ns[i];
                                                       }}));
  NERITIC_ASSERT_OK(const auto view,
                    DiveView::create(*session, *headset, nullptr, nullptr, {.governed = true}));
  EXPECT_EQ(view->budget_ms(), 0.0);
  for (std::size_t i = 0; i < std::size(kTold_ns); ++i) {
    NERITIC_ASSERT_OK(const xr::FrameVerdict verdict, view->begin_frame());
    EXPECT_EQ(verdict, xr::FrameVerdict::kDraw);
    EXPECT_DOUBLE_EQ(view->budget_ms(), kBudget_ms[i]) << i;
    NERITIC_ASSERT_STATUS(view->end_frame({}));
  }
}

TEST_F(HeadsetView, AStereoPairIsDrawnFromTheTrackedHead) {
  expect_all_views({xr::eye_pair(120, 110)});
}

TEST_F(HeadsetView, FourViewsAreDrawnInTwoGroupsOfTheirOwnSizes) {
  expect_all_views({xr::eye_pair(100, 90), xr::eye_pair(140, 130, 0.25)});
}

}  // namespace
}  // namespace neritic::testbed
