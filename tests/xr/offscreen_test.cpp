// The display that nobody looks at: its clock and its frames.
#include "engine/xr/offscreen.hpp"

#include <gtest/gtest.h>

#include "tests/support/gpu_fixture.hpp"

namespace neritic::xr {
namespace {

using OffscreenDisplayTest = test::GpuTest;

TEST_F(OffscreenDisplayTest, FastFramesAreExactlyOnePeriodApart) {
  NERITIC_ASSERT_OK(const auto display, OffscreenDisplay::create(device(), {64, 32, 25.0, true}));
  NERITIC_ASSERT_OK(const DisplayFrame first, display->begin_frame());
  for (int i = 1; i < 5; ++i) {
    NERITIC_ASSERT_STATUS(display->end_frame());
    NERITIC_ASSERT_OK(const DisplayFrame next, display->begin_frame());
    EXPECT_EQ(next.predicted_display_ns - first.predicted_display_ns, i * 40'000'000);
  }
}

TEST_F(OffscreenDisplayTest, RealTimeFramesWaitForTheirRate) {
  NERITIC_ASSERT_OK(const auto display, OffscreenDisplay::create(device(), {64, 32, 50.0, false}));
  const TimeNs begun = now_ns();
  TimeNs last = 0;
  for (int i = 0; i < 6; ++i) {
    NERITIC_ASSERT_OK(const DisplayFrame frame, display->begin_frame());
    EXPECT_GT(frame.predicted_display_ns, last);
    last = frame.predicted_display_ns;
  }
  EXPECT_GE(now_ns() - begun, 5 * 20'000'000);  // five periods lie between six frames
}

TEST_F(OffscreenDisplayTest, OneEyeOfThePicturesShapeAndFieldOfView) {
  NERITIC_ASSERT_OK(const auto display, OffscreenDisplay::create(device(), {200, 100, 30.0, true}));
  display->set_vertical_fov(radians(90.0));
  NERITIC_ASSERT_OK(const DisplayFrame frame, display->begin_frame());
  EXPECT_EQ(frame.verdict, FrameVerdict::kDraw);
  ASSERT_EQ(frame.eyes.size(), 1u);
  EXPECT_NEAR(frame.eyes[0].tangents.top, 1.0, 1e-12);
  EXPECT_NEAR(frame.eyes[0].tangents.right, 2.0, 1e-12);
  EXPECT_EQ(display->target().desc().width, 200u);
  EXPECT_EQ(display->target().desc().height, 100u);
}

}  // namespace
}  // namespace neritic::xr
