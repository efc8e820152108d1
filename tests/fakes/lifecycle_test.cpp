// A correct client lives through a session of the fake runtime, and the runtime does what its
// script says.
#include <gmock/gmock.h>

#include "tests/fakes/client.hpp"
#include "tests/fakes/fake_headset.hpp"
#include "tests/support/device_gate.hpp"

namespace neritic::fakes {
namespace {

using ::testing::ElementsAre;

class FakeRuntime : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  }
};

TEST_F(FakeRuntime, ACorrectClientIsFocusedAndDrawsWithoutAFault) {
  FakeHeadset headset;
  Client client;
  client.start();
  EXPECT_THAT(client.states, ElementsAre(XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY,
                                         XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_VISIBLE,
                                         XR_SESSION_STATE_FOCUSED));
  for (int i = 0; i < 5; ++i) client.frame();
  EXPECT_TRUE(client.state.shouldRender);
  EXPECT_EQ(xrRequestExitSession(client.session), XR_SUCCESS);
  client.poll();
  EXPECT_EQ(client.session_state, XR_SESSION_STATE_EXITING);
  client.destroy();
  EXPECT_THAT(client.validation, ElementsAre());
}

TEST_F(FakeRuntime, FramesComeAtTheSimulatedPeriodAndLateOnesWhereTheScriptSays) {
  FakeHeadset headset("period 0.010\nlate 3 2\n");
  Client client;
  client.start();
  std::vector<XrDuration> steps;
  XrTime last = client.state.predictedDisplayTime;
  for (int i = 0; i < 4; ++i) {
    client.frame();
    steps.push_back(client.state.predictedDisplayTime - last);
    last = client.state.predictedDisplayTime;
  }
  EXPECT_THAT(steps, ElementsAre(10'000'000, 10'000'000, 30'000'000, 10'000'000));
}

}  // namespace
}  // namespace neritic::fakes
