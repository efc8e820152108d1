// The life of a dive in a headset: from the first frame to the wearer's "quit", through a session
// and a runtime that go away and come back.
#include <gmock/gmock.h>

#include "tests/testbed/headset/headset_run.hpp"

namespace neritic::testbed {
namespace {

using ::testing::HasSubstr;

class HeadsetLife : public HeadsetRun {
 protected:
  static scene::Scene scene() {
    return xr::ball_scene("[[cameras]]\nname = \"eyes\"\nwidth = 33\nheight = 22\n");
  }
};
const std::string kSmall = "size 64 60\n";

TEST_F(HeadsetLife, ADiveIsShownFrameByFrameUntilItEnds) {
  fakes::FakeHeadset fake(kSmall);
  NERITIC_ASSERT_STATUS(dive(scene(), 4));
  EXPECT_EQ(shown(), 4u);
}

TEST_F(HeadsetLife, TheRuntimesPeriodIsTheBudgetOfAFrame) {
  govern();
  {
    fakes::FakeHeadset fake(kSmall + "period 0.0125\n");
    NERITIC_ASSERT_STATUS(dive(scene(), 3));
    EXPECT_DOUBLE_EQ(budget_ms(), 12.5);
  }
  fakes::FakeHeadset fake(kSmall + "period 0.5\n");  // no screen's
  NERITIC_ASSERT_STATUS(dive(scene(), 3));
  EXPECT_NEAR(budget_ms(), 1e3 / 90.0, 1e-3);
}

TEST_F(HeadsetLife, TwoDivesRunOneAfterTheOther) {
  fakes::FakeHeadset fake(kSmall);
  NERITIC_ASSERT_STATUS(dive(scene(), 2));
  NERITIC_ASSERT_STATUS(dive(scene(), 2));
}

TEST_F(HeadsetLife, QuitFromTheRuntimeEndsTheDive) {
  fakes::FakeHeadset fake(kSmall + "frame 4 exit\n");
  NERITIC_ASSERT_STATUS(dive(scene(), 0));
  EXPECT_GE(shown(), 2u);
}

TEST_F(HeadsetLife, AHeadsetTakenOffShowsNothingAndShowsAgainWhenItIsBack) {
  fakes::FakeHeadset fake(kSmall +
                          "frame 3 stop 5\nframe 6 visible\nframe 7 synchronized\n"
                          "frame 9 focused\n");
  NERITIC_ASSERT_STATUS(dive(scene(), 6));
}

TEST_F(HeadsetLife, ALostSessionIsMadeAnewAndTheDiveGoesOn) {
  fakes::FakeHeadset fake(kSmall + "frame 3 session_lost\n");
  NERITIC_ASSERT_STATUS(dive(scene(), 6));
  EXPECT_EQ(shown(), 6u);
}

TEST_F(HeadsetLife, AnAnnouncedLossOfTheSessionIsNoEndEither) {
  fakes::FakeHeadset fake(kSmall + "frame 3 loss_pending\n");
  NERITIC_ASSERT_STATUS(dive(scene(), 6));
}

TEST_F(HeadsetLife, TheDiveGoesOnUnseenWhileTheRuntimeIsAway) {
  without_layer();
  fakes::FakeHeadset fake(kSmall + "frame 3 instance_lost\nframe 3 instance_refusals 1000\n");
  end_after(0.8);
  NERITIC_ASSERT_STATUS(dive(scene(), 0));
  EXPECT_GE(shown(), 2u);
}

TEST_F(HeadsetLife, NoRuntimeIsOneLine) {
  without_layer();
  fakes::FakeHeadset fake("available no\n");
  const Status status = dive(scene(), 1);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kNoDevice);
  EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
}

TEST_F(HeadsetLife, ARuntimeWithoutAHeadsetSaysSo) {
  fakes::FakeHeadset fake("system_refusals 1000\n");
  const Status status = dive(scene(), 1);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("has no headset now"));
}

TEST_F(HeadsetLife, PicturesGoInTheFormatThatTheRuntimeTakes) {
  for (const char* format : {"R16G16B16A16_SFLOAT", "B8G8R8A8_SRGB", "R8G8B8A8_UNORM"}) {
    fakes::FakeHeadset fake(kSmall + "formats " + format + "\n");
    NERITIC_ASSERT_STATUS(dive(scene(), 2));
  }
}

TEST_F(HeadsetLife, AFormatThatNobodyCanDrawIsNamed) {
  fakes::FakeHeadset fake(kSmall + "formats D16_UNORM\n");
  const Status status = dive(scene(), 2);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("accepted: R8G8B8A8_SRGB"));
}

TEST_F(HeadsetLife, FourViewsAndARuntimeWithoutExtrasAreShownToo) {
  {
    fakes::FakeHeadset fake(kSmall + "views 4\nfocus_size 40 40\n");
    NERITIC_ASSERT_STATUS(dive(scene(), 2));
  }
  fakes::FakeHeadset fake(kSmall +
                          "views 1\nstage no\nwithout XR_KHR_convert_timespec_time "
                          "XR_KHR_composition_layer_depth XR_VARJO_quad_views\n");
  NERITIC_ASSERT_STATUS(dive(scene(), 2));
}

}  // namespace
}  // namespace neritic::testbed
