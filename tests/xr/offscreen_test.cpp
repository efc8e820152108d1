// The display that nobody looks at: its frames.
#include "engine/xr/offscreen.hpp"

#include <gtest/gtest.h>

#include "tests/support/gpu_fixture.hpp"

namespace neritic::xr {
namespace {

using OffscreenDisplayTest = test::GpuTest;

// The program's clock paces: a display that waited too would halve the rate.
TEST_F(OffscreenDisplayTest, ItNeitherWaitsNorSaysWhenAFrameIsSeen) {
  NERITIC_ASSERT_OK(const auto display,
                    OffscreenDisplay::create(device(), {{one_view(64, 32, radians(60.0))}}));
  for (int i = 0; i < 3; ++i) {
    NERITIC_ASSERT_OK(const DisplayFrame frame, display->begin_frame({}));
    EXPECT_EQ(frame.verdict, FrameVerdict::kDraw);
    EXPECT_FALSE(frame.display_at_ns);
    EXPECT_FALSE(frame.period_ns);
    NERITIC_ASSERT_STATUS(display->end_frame(false));
  }
}

TEST_F(OffscreenDisplayTest, OneViewHasThePicturesShapeAndFieldOfView) {
  NERITIC_ASSERT_OK(const auto display,
                    OffscreenDisplay::create(device(), {{one_view(200, 100, radians(90.0))}}));
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
