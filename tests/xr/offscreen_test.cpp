// The display that nobody looks at: its clock and its frames.
#include "engine/xr/offscreen.hpp"

#include <gtest/gtest.h>

#include "tests/support/gpu_fixture.hpp"

namespace neritic::xr {
namespace {

using OffscreenDisplayTest = test::GpuTest;

OffscreenOptions options(double rate_hz, bool fast) {
  return {{one_view(64, 32, radians(60.0))}, rate_hz, fast};
}

TEST_F(OffscreenDisplayTest, FastFramesAreExactlyOnePeriodApart) {
  NERITIC_ASSERT_OK(const auto display, OffscreenDisplay::create(device(), options(25.0, true)));
  NERITIC_ASSERT_OK(const DisplayFrame first, display->begin_frame({}));
  EXPECT_EQ(first.period_ns, 40'000'000);
  for (int i = 1; i < 5; ++i) {
    NERITIC_ASSERT_STATUS(display->end_frame());
    NERITIC_ASSERT_OK(const DisplayFrame next, display->begin_frame({}));
    EXPECT_EQ(next.display_at_ns - first.display_at_ns, i * 40'000'000);
  }
}

TEST_F(OffscreenDisplayTest, RealTimeFramesWaitForTheirRate) {
  NERITIC_ASSERT_OK(const auto display, OffscreenDisplay::create(device(), options(50.0, false)));
  const TimeNs begun = now_ns();
  TimeNs last = 0;
  for (int i = 0; i < 6; ++i) {
    NERITIC_ASSERT_OK(const DisplayFrame frame, display->begin_frame({}));
    EXPECT_GT(frame.display_at_ns, last);
    last = frame.display_at_ns;
  }
  EXPECT_GE(now_ns() - begun, 5 * 20'000'000);  // five periods lie between six frames
}

TEST_F(OffscreenDisplayTest, OneViewHasThePicturesShapeAndFieldOfView) {
  NERITIC_ASSERT_OK(
      const auto display,
      OffscreenDisplay::create(device(), {{one_view(200, 100, radians(90.0))}, 30.0, true}));
  NERITIC_ASSERT_OK(const DisplayFrame frame, display->begin_frame({}));
  EXPECT_EQ(frame.verdict, FrameVerdict::kDraw);
  EXPECT_FALSE(frame.world_from_head);  // the program's camera is the head
  ASSERT_EQ(frame.groups.size(), 1u);
  ASSERT_EQ(frame.groups[0].views.size(), 1u);
  EXPECT_NEAR(frame.groups[0].views[0].tangents.top, 1.0, 1e-12);
  EXPECT_NEAR(frame.groups[0].views[0].tangents.right, 2.0, 1e-12);
  EXPECT_EQ(display->picture(0).desc().width, 200u);
  EXPECT_EQ(display->picture(0).desc().height, 100u);
}

}  // namespace
}  // namespace neritic::xr
