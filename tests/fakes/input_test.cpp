// Hands, eyes and controllers come from the fake runtime as its script says.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "tests/fakes/client.hpp"
#include "tests/fakes/core_validation.hpp"
#include "tests/fakes/fake_headset.hpp"
#include "tests/support/device_gate.hpp"

namespace neritic::fakes {
namespace {

using ::testing::HasSubstr;

// Actions of a client and their bindings, step by step.
struct Input {
  Client& client;
  XrActionSet set = XR_NULL_HANDLE;

  explicit Input(Client& of) : client(of) {
    XrActionSetCreateInfo info{XR_TYPE_ACTION_SET_CREATE_INFO};
    std::strcpy(info.actionSetName, "dive");
    std::strcpy(info.localizedActionSetName, "Dive");
    EXPECT_EQ(xrCreateActionSet(client.instance, &info, &set), XR_SUCCESS);
  }
  XrPath path(const std::string& text) {
    XrPath made = XR_NULL_PATH;
    EXPECT_EQ(xrStringToPath(client.instance, text.c_str(), &made), XR_SUCCESS) << text;
    return made;
  }
  XrAction action(const char* name, XrActionType type) {
    XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
    std::strcpy(info.actionName, name);
    std::strcpy(info.localizedActionName, name);
    info.actionType = type;
    XrAction made = XR_NULL_HANDLE;
    EXPECT_EQ(xrCreateAction(set, &info, &made), XR_SUCCESS) << name;
    return made;
  }
  XrResult suggest(const std::string& profile, XrAction action, const std::string& binding) {
    const XrActionSuggestedBinding one{action, path(binding)};
    XrInteractionProfileSuggestedBinding info{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING};
    info.interactionProfile = path("/interaction_profiles/" + profile);
    info.countSuggestedBindings = 1;
    info.suggestedBindings = &one;
    return xrSuggestInteractionProfileBindings(client.instance, &info);
  }
  void attach() {
    XrSessionActionSetsAttachInfo info{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr, 1, &set};
    EXPECT_EQ(xrAttachSessionActionSets(client.session, &info), XR_SUCCESS);
  }
  XrResult sync() {
    const XrActiveActionSet active{set, XR_NULL_PATH};
    const XrActionsSyncInfo info{XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 1, &active};
    return xrSyncActions(client.session, &info);
  }
  XrSpace space(XrAction action) {
    const XrActionSpaceCreateInfo info{
        XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, action, XR_NULL_PATH, {{0, 0, 0, 1}, {}}};
    XrSpace made = XR_NULL_HANDLE;
    EXPECT_EQ(xrCreateActionSpace(client.session, &info, &made), XR_SUCCESS);
    return made;
  }
};

class HeadsetInput : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  }
};

TEST_F(HeadsetInput, AStickGivesItsScriptedValueWhileTheProgramIsFocused) {
  FakeHeadset headset(
      "period 0.01\nprofile both oculus/touch_controller\ncontroller left 0 0 1 -0.3\n"
      "input /user/hand/left/input/thumbstick 0 0.25 -0.5\n"
      "input /user/hand/left/input/thumbstick 0.035 0 1\n");
  Client client;
  client.make_instance();
  client.get_system();
  Input input(client);
  const XrAction swim = input.action("swim", XR_ACTION_TYPE_VECTOR2F_INPUT);
  EXPECT_EQ(input.suggest("oculus/touch_controller", swim, "/user/hand/left/input/thumbstick"),
            XR_SUCCESS);
  client.make_device();
  client.make_session();
  client.make_space();
  client.begin_session();
  client.make_swapchain();
  input.attach();
  EXPECT_EQ(input.sync(), XR_SESSION_NOT_FOCUSED);
  const auto read = [&] {
    const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, swim};
    XrActionStateVector2f state{XR_TYPE_ACTION_STATE_VECTOR2F};
    EXPECT_EQ(xrGetActionStateVector2f(client.session, &get, &state), XR_SUCCESS);
    return state;
  };
  EXPECT_FALSE(read().isActive);
  client.frame();  // 0.01 s
  EXPECT_EQ(input.sync(), XR_SUCCESS);
  EXPECT_TRUE(read().isActive);
  EXPECT_EQ(read().currentState.x, 0.25f);
  EXPECT_EQ(read().currentState.y, -0.5f);
  for (int i = 0; i < 3; ++i) client.frame();  // 0.04 s
  EXPECT_EQ(input.sync(), XR_SUCCESS);
  EXPECT_EQ(read().currentState.y, 1.0f);
  EXPECT_TRUE(read().changedSinceLastSync);
  headset.happen("visible");
  EXPECT_EQ(input.sync(), XR_SESSION_NOT_FOCUSED);
  EXPECT_FALSE(read().isActive);
}

TEST_F(HeadsetInput, ABindingOfAnotherKindOrAnUnknownPathIsAFault) {
  FakeHeadset headset;
  headset.expect_faults();
  Client client;
  client.make_instance();
  Input input(client);
  const XrAction fire = input.action("inflate", XR_ACTION_TYPE_BOOLEAN_INPUT);
  EXPECT_EQ(input.suggest("khr/simple_controller", fire, "/user/hand/left/input/grip/pose"),
            XR_ERROR_PATH_UNSUPPORTED);
  EXPECT_THAT(headset.faults(), HasSubstr("the action inflate cannot be bound to"));
  EXPECT_EQ(input.suggest("khr/simple_controller", fire, "/user/hand/left/input/trigger/value"),
            XR_ERROR_PATH_UNSUPPORTED);
  EXPECT_THAT(headset.faults(), HasSubstr("does not exist in"));
  EXPECT_EQ(input.suggest("acme/wand", fire, "/user/hand/left/input/select/click"),
            XR_ERROR_PATH_UNSUPPORTED);
  EXPECT_THAT(headset.faults(), HasSubstr("/interaction_profiles/acme/wand is no interaction"));
}

TEST_F(HeadsetInput, TheGazeComesWithTheTimeOfItsLastSample) {
  FakeHeadset headset("period 0.01\ngaze_period 0.004\nhead 0 0 1.6 0\ngaze 0 0\ngaze 1 10\n");
  Client client;
  client.make_instance({XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME});
  client.get_system();
  Input input(client);
  const XrAction gaze = input.action("gaze", XR_ACTION_TYPE_POSE_INPUT);
  EXPECT_EQ(input.suggest("ext/eye_gaze_interaction", gaze, "/user/eyes_ext/input/gaze_ext/pose"),
            XR_SUCCESS);
  client.make_device();
  client.make_session();
  client.make_space(XR_REFERENCE_SPACE_TYPE_VIEW);
  client.begin_session();
  client.make_swapchain();
  input.attach();
  const XrSpace eyes = input.space(gaze);
  client.frame();
  client.frame();  // 0.02 s: samples every 4 ms, so the last one is that moment's
  EXPECT_EQ(input.sync(), XR_SUCCESS);
  XrEyeGazeSampleTimeEXT sample{XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT};
  XrSpaceLocation at{XR_TYPE_SPACE_LOCATION, &sample};
  EXPECT_EQ(xrLocateSpace(eyes, client.space, client.state.predictedDisplayTime, &at), XR_SUCCESS);
  EXPECT_EQ(sample.time, 10'020'000'000);
  EXPECT_TRUE(at.locationFlags & XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT);
  EXPECT_NEAR(2 * std::asin(at.pose.orientation.y) * 180 / M_PI, 0.2, 1e-4);  // to the left
}

TEST_F(HeadsetInput, AHandsJointsFollowItsWristAndClose) {
  FakeHeadset headset("hand right 0 0.3 1.2 -0.4\ncurl right 0 0\ncurl right 1 1\n");
  Client client;
  client.start({XR_EXT_HAND_TRACKING_EXTENSION_NAME});
  const auto create = client.function<PFN_xrCreateHandTrackerEXT>("xrCreateHandTrackerEXT");
  const auto locate = client.function<PFN_xrLocateHandJointsEXT>("xrLocateHandJointsEXT");
  const XrHandTrackerCreateInfoEXT info{XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT, nullptr,
                                        XR_HAND_RIGHT_EXT, XR_HAND_JOINT_SET_DEFAULT_EXT};
  XrHandTrackerEXT tracker = XR_NULL_HANDLE;
  ASSERT_EQ(create(client.session, &info, &tracker), XR_SUCCESS);
  client.make_space(XR_REFERENCE_SPACE_TYPE_STAGE);
  std::vector<XrHandJointLocationEXT> joints(XR_HAND_JOINT_COUNT_EXT);
  const auto tip_at = [&](XrTime time) {
    XrHandJointLocationsEXT locations{XR_TYPE_HAND_JOINT_LOCATIONS_EXT};
    locations.jointCount = XR_HAND_JOINT_COUNT_EXT;
    locations.jointLocations = joints.data();
    const XrHandJointsLocateInfoEXT where{XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT, nullptr,
                                          client.space, time};
    EXPECT_EQ(locate(tracker, &where, &locations), XR_SUCCESS);
    EXPECT_TRUE(locations.isActive);
    return joints[XR_HAND_JOINT_MIDDLE_TIP_EXT].pose.position;
  };
  const XrVector3f open = tip_at(10'000'000'000);
  EXPECT_NEAR(joints[XR_HAND_JOINT_WRIST_EXT].pose.position.x, 0.3, 1e-6);
  EXPECT_NEAR(-0.4 - open.z, 0.192, 1e-3);  // a hand's length before the wrist
  const XrVector3f closed = tip_at(11'500'000'000);
  EXPECT_LT(closed.y, open.y - 0.02);
  EXPECT_GT(closed.z, open.z + 0.08);
}

TEST_F(HeadsetInput, TheCoreValidationLayerHasNothingToSay) {
  if (!CoreValidation::installed()) GTEST_SKIP() << "no package openxr-layer-corevalidation";
  CoreValidation validation;
  {
    FakeHeadset headset("profile both khr/simple_controller\ncontroller right 0 0 1 -0.3\n");
    Client client;
    client.make_instance();
    client.get_system();
    Input input(client);
    const XrAction aim = input.action("aim", XR_ACTION_TYPE_POSE_INPUT);
    EXPECT_EQ(input.suggest("khr/simple_controller", aim, "/user/hand/right/input/aim/pose"),
              XR_SUCCESS);
    client.make_device();
    client.make_session();
    client.make_space();
    client.begin_session();
    client.make_swapchain();
    input.attach();
    input.space(aim);
    client.frame();
    EXPECT_EQ(input.sync(), XR_SUCCESS);
    client.frame();
    EXPECT_EQ(xrRequestExitSession(client.session), XR_SUCCESS);
    client.poll();
  }
  EXPECT_EQ(validation.messages(), "");
}

TEST_F(HeadsetInput, TheCoreValidationLayerSpeaksOfAWrongCall) {
  if (!CoreValidation::installed()) GTEST_SKIP() << "no package openxr-layer-corevalidation";
  CoreValidation validation;
  {
    FakeHeadset headset;
    headset.expect_faults();
    Client client;
    client.make_instance();
    XrSystemGetInfo info{XR_TYPE_SESSION_CREATE_INFO};
    EXPECT_LT(xrGetSystem(client.instance, &info, &client.system), 0);
  }
  EXPECT_THAT(validation.messages(), HasSubstr("xrGetSystem"));
}

}  // namespace
}  // namespace neritic::fakes
