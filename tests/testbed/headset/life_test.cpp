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
// Where an instance is refused, OpenXR's validation layer (1.0.20) goes on to ask for its
// functions.
const std::string kLayersFault = "was asked for without an instance";

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
  fakes::FakeHeadset fake(kSmall + "frame 3 instance_lost\nframe 3 instance_refusals 1000\n");
  fake.forgive(kLayersFault);
  end_after(0.8);
  NERITIC_ASSERT_STATUS(dive(scene(), 0));
  EXPECT_GE(shown(), 2u);
}

// The runtime comes back as another instance, which did not make the dive's graphics device.
TEST_F(HeadsetLife, ARuntimeThatComesBackShowsTheDiveAgain) {
  for (const char* loss : {"instance_lost", "instance_loss_pending"}) {
    fakes::FakeHeadset fake(kSmall + "frame 3 instance_refusals 1\nframe 3 " + loss + "\n");
    fake.forgive(kLayersFault);
    NERITIC_ASSERT_STATUS(dive(scene(), 8));
    EXPECT_EQ(shown(), 8u) << loss;
  }
}

TEST_F(HeadsetLife, ARuntimeThatTakesOnlyItsOwnDeviceSaysSoWhenItIsBack) {
  const auto said = [&](const std::string& lines) {
    fakes::FakeHeadset fake(kSmall + "real_time yes\nperiod 0.05\nframe 3 instance_lost\n" + lines);
    end_after(3.0);
    ::testing::internal::CaptureStderr();
    EXPECT_TRUE(dive(scene(), 0).ok());
    return ::testing::internal::GetCapturedStderr();
  };
  EXPECT_THAT(said("without XR_KHR_vulkan_enable\n"),
              HasSubstr("came back without XR_KHR_vulkan_enable, so that it takes no graphics "
                        "device but one that it makes anew: start the dive again\n"));
  EXPECT_THAT(said("frame 3 vulkan_device_extensions VK_KHR_dedicated_allocation VK_EXT_other\n"),
              HasSubstr("came back and needs Vulkan's VK_EXT_other"));
}

// The instance is not thrown away: a second one would be refused.
TEST_F(HeadsetLife, AHeadsetThatIsUnpluggedForAWhileIsWaitedFor) {
  fakes::FakeHeadset fake(kSmall +
                          "frame 3 instance_refusals 1000\nframe 3 system_refusals 2\n"
                          "frame 3 loss_pending\n");
  NERITIC_ASSERT_STATUS(dive(scene(), 6));
  EXPECT_EQ(shown(), 6u);
}

// The headset is tried again also if its session cannot be made at once.
TEST_F(HeadsetLife, ASessionThatIsRefusedAtFirstIsTriedAgain) {
  fakes::FakeHeadset fake(kSmall +
                          "frame 3 instance_refusals 1000\nframe 3 fails xrCreateSession 1\n"
                          "frame 3 session_lost\n");
  NERITIC_ASSERT_STATUS(dive(scene(), 6));
  EXPECT_EQ(shown(), 6u);
}

TEST_F(HeadsetLife, OneFailedCallIsNoLostRuntime) {
  for (const char* function : {"xrPollEvent", "xrWaitFrame", "xrBeginFrame", "xrLocateSpace",
                               "xrLocateViews", "xrSyncActions", "xrAcquireSwapchainImage",
                               "xrWaitSwapchainImage", "xrReleaseSwapchainImage", "xrEndFrame"}) {
    fakes::FakeHeadset fake(kSmall + "frame 3 instance_refusals 1000\nframe 3 fails " + function +
                            " 1\n");
    NERITIC_ASSERT_STATUS(dive(scene(), 7));
    EXPECT_EQ(shown(), 7u) << function;
  }
}

TEST_F(HeadsetLife, CallsThatGoOnFailingCostTheSession) {
  fakes::FakeHeadset fake(kSmall + "frame 3 instance_refusals 1000\nframe 3 fails xrEndFrame 10\n");
  NERITIC_ASSERT_STATUS(dive(scene(), 16));
  EXPECT_EQ(shown(), 16u);
}

TEST_F(HeadsetLife, AHeadThatIsTurnedButNowhereIsAtItsLastPlace) {
  {
    fakes::FakeHeadset fake(kSmall + "period 0.1\nhead 0 0 1.5 0\nhead 1 0 1.5 0 40\n");
    fake.write("positioned 0.55 no\n");
    NERITIC_ASSERT_STATUS(dive(scene(), 6));
    EXPECT_EQ(shown(), 6u);
    EXPECT_THAT(fake.log(), HasSubstr("frame 5 "));
    std::istringstream lines(fake.log());
    for (std::string line; std::getline(lines, line);) {
      const auto at = line.find("projection");
      if (at == std::string::npos) continue;
      EXPECT_THAT(line.substr(at), HasSubstr("projection 0.00 mm 0.0")) << line;
    }
  }
  {
    // In a dive without a room: where it was recentred.
    fakes::FakeHeadset fake(kSmall + "head 0 0 1.6 0\npositioned 0 no\n");
    NERITIC_ASSERT_STATUS(dive(scene(), 3));
    EXPECT_THAT(fake.log(), HasSubstr("projection 0.00 mm 0.00 deg"));
  }
  fakes::FakeHeadset fake(kSmall + "oriented 0 no\n");
  end_after(0.3);
  NERITIC_ASSERT_STATUS(dive(scene(), 0));
  EXPECT_THAT(fake.log(), ::testing::Not(HasSubstr("projection")));
}

TEST_F(HeadsetLife, ARefusedExtraIsNotMissed) {
  const auto said = [&](const std::string& lines) {
    fakes::FakeHeadset fake(kSmall + lines);
    ::testing::internal::CaptureStderr();
    EXPECT_TRUE(dive(scene(), 2).ok());
    EXPECT_EQ(shown(), 2u);
    return ::testing::internal::GetCapturedStderr();
  };
  EXPECT_THAT(said("fails xrCreateSwapchain 1 1\n"),
              HasSubstr("xrCreateSwapchain: XR_ERROR_RUNTIME_FAILURE: the pictures go without"));
  EXPECT_THAT(said("views 4\nfocus_size 40 40\ngaze 0 0 0\nfails xrCreateReferenceSpace 1 2\n"),
              HasSubstr("the sharp views stay in the middle"));
  ask_for_rate(90.0);
  EXPECT_THAT(said("fails xrRequestDisplayRefreshRateFB 1\n"),
              HasSubstr("the display keeps its own rate"));
}

TEST_F(HeadsetLife, NoRuntimeIsOneLine) {
  fakes::FakeHeadset fake("available no\n");
  fake.forgive(kLayersFault);
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
  EXPECT_THAT(status.error().message, HasSubstr("the Vulkan formats D16_UNORM only"));
  EXPECT_THAT(status.error().message, HasSubstr("accepted: R8G8B8A8_SRGB"));
}

// A runtime's setting of supersampling may recommend more than its images may have.
TEST_F(HeadsetLife, ViewsAreNoLargerThanTheRuntimesImages) {
  fakes::FakeHeadset fake("size 64 60\nmax_size 48\n");
  ::testing::internal::CaptureStderr();
  NERITIC_ASSERT_STATUS(dive(scene(), 2));
  EXPECT_EQ(shown(), 2u);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              HasSubstr("recommends views of 64 x 60 pixels, but takes 48 x 48 at most"));
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
