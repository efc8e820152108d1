#include "engine/xr/openxr/inputs.hpp"

#include <algorithm>
#include <cstring>

#include "engine/xr/openxr/bindings.hpp"

namespace neritic::xr::openxr {
namespace {

constexpr double kPressed = 0.5;
constexpr const char* kSides[2] = {"left", "right"};
constexpr const char* kGazeProfile = "/interaction_profiles/ext/eye_gaze_interaction";
constexpr const char* kGazePath = "/user/eyes_ext/input/gaze_ext/pose";

// OpenXR's axes of a wrist: y out of the back of the hand, z from the fingers to the wrist. Ours
// (Tracked): the back of the right hand looks along x, that of the left one against it.
Quat wrist_from_ours(bool right) {
  const double side = right ? 1.0 : -1.0;
  return glm::normalize(glm::quat_cast(Mat3(Vec3(0, side, 0), Vec3(0, 0, 1), Vec3(side, 0, 0))));
}
// The axes of a grip are ours (OpenXR 1.0, section 6.3.1): x through the palm, -z from the little
// finger to the thumb. Its origin is the middle of the palm, 0.08 m before the wrist.
const Pose kGripFromWrist{{0.0, 0.08, 0.0}};

template <std::size_t n>
void put(char (&to)[n], const std::string& text) {
  std::strncpy(to, text.c_str(), n - 1);
  to[n - 1] = '\0';
}

}  // namespace

Result<std::unique_ptr<Inputs>> Inputs::create(Runtime& runtime, const Session& session) {
  std::unique_ptr<Inputs> inputs(new Inputs(runtime, session));
  if (!runtime.xr().CreateActionSet) return inputs;  // a runtime without input
  XrActionSetCreateInfo info{XR_TYPE_ACTION_SET_CREATE_INFO};
  put(info.actionSetName, "dive");
  put(info.localizedActionSetName, "Dive");
  NERITIC_TRY_STATUS(runtime.check(
      runtime.xr().CreateActionSet(runtime.instance(), &info, &inputs->set_), "xrCreateActionSet"));
  NERITIC_TRY_STATUS(inputs->create_actions());
  NERITIC_TRY_STATUS(inputs->create_poses());
  NERITIC_TRY_STATUS(inputs->suggest());
  NERITIC_TRY_STATUS(inputs->attach());
  inputs->make_trackers();
  return inputs;
}

Inputs::~Inputs() {
  for (const XrHandTrackerEXT tracker : trackers_)
    if (tracker != XR_NULL_HANDLE) (void)runtime_.xr().DestroyHandTrackerEXT(tracker);
  // Its actions go with it; their spaces with the session.
  if (set_ != XR_NULL_HANDLE) (void)runtime_.xr().DestroyActionSet(set_);
}

XrPath Inputs::path(const std::string& text) const {
  XrPath found = XR_NULL_PATH;
  (void)runtime_.xr().StringToPath(runtime_.instance(), text.c_str(), &found);
  return found;
}

Result<XrAction> Inputs::action(const std::string& name, XrActionType type) {
  XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
  std::string plain = name;
  std::replace(plain.begin(), plain.end(), ' ', '_');
  put(info.actionName, plain);
  put(info.localizedActionName, name);
  info.actionType = type;
  XrAction made = XR_NULL_HANDLE;
  NERITIC_TRY_STATUS(
      runtime_.check(runtime_.xr().CreateAction(set_, &info, &made), "xrCreateAction"));
  return made;
}

// A number for each control that any profile gives; the runtime turns buttons into 0 and 1.
Status Inputs::create_actions() {
  for (const InteractionProfile& profile : interaction_profiles())
    for (const ControlPart& part : profile.parts) {
      NERITIC_TRY(const std::size_t control, control_id(part.control));
      const bool known =
          std::any_of(controls_.begin(), controls_.end(),
                      [&](const ControlAction& one) { return one.control == control; });
      if (known) continue;
      NERITIC_TRY(const XrAction made, action(part.control, XR_ACTION_TYPE_FLOAT_INPUT));
      controls_.push_back({made, control, part.sign});
    }
  return {};
}

Status Inputs::create_poses() {
  for (std::size_t side = 0; side < 2; ++side) {
    NERITIC_TRY(grips_[side],
                action(fmt::format("{} grip", kSides[side]), XR_ACTION_TYPE_POSE_INPUT));
    NERITIC_TRY(grip_spaces_[side], space_of(grips_[side]));
  }
  if (!runtime_.gaze_here()) return {};
  NERITIC_TRY(gaze_, action("gaze", XR_ACTION_TYPE_POSE_INPUT));
  NERITIC_TRY(gaze_space_, space_of(gaze_));
  return {};
}

Result<XrSpace> Inputs::space_of(XrAction action) {
  XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO};
  info.action = action;
  info.poseInActionSpace = to_xr({});
  XrSpace space = XR_NULL_HANDLE;
  NERITIC_TRY_STATUS(runtime_.check(
      runtime_.xr().CreateActionSpace(session_.handle(), &info, &space), "xrCreateActionSpace"));
  return space;
}

// A profile that the runtime does not know is none of ours to miss.
Status Inputs::suggest() {
  const auto give = [&](const char* profile, std::vector<XrActionSuggestedBinding> bindings) {
    XrInteractionProfileSuggestedBinding info{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING};
    info.interactionProfile = path(profile);
    info.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
    info.suggestedBindings = bindings.data();
    const XrResult result =
        runtime_.xr().SuggestInteractionProfileBindings(runtime_.instance(), &info);
    return result == XR_ERROR_PATH_UNSUPPORTED
               ? Status()
               : runtime_.check(result, "xrSuggestInteractionProfileBindings");
  };
  for (const InteractionProfile& profile : interaction_profiles()) {
    std::vector<XrActionSuggestedBinding> bindings;
    for (const ControlPart& part : profile.parts) {
      NERITIC_TRY(const std::size_t control, control_id(part.control));
      for (const ControlAction& one : controls_)
        if (one.control == control) bindings.push_back({one.action, path(part.path)});
    }
    for (std::size_t side = 0; profile.hands && side < 2; ++side)
      bindings.push_back(
          {grips_[side], path(fmt::format("/user/hand/{}/input/grip/pose", kSides[side]))});
    NERITIC_TRY_STATUS(give(profile.path, std::move(bindings)));
  }
  return gaze_ == XR_NULL_HANDLE ? Status() : give(kGazeProfile, {{gaze_, path(kGazePath)}});
}

Status Inputs::attach() {
  XrSessionActionSetsAttachInfo info{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO};
  info.countActionSets = 1;
  info.actionSets = &set_;
  return runtime_.check(runtime_.xr().AttachSessionActionSets(session_.handle(), &info),
                        "xrAttachSessionActionSets");
}

// A headset that cannot track hands refuses; its controllers are the hands then.
void Inputs::make_trackers() {
  if (!runtime_.hands_here() || !runtime_.xr().CreateHandTrackerEXT) return;
  for (std::size_t side = 0; side < 2; ++side) {
    XrHandTrackerCreateInfoEXT info{XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT};
    info.hand = side == 0 ? XR_HAND_LEFT_EXT : XR_HAND_RIGHT_EXT;
    info.handJointSet = XR_HAND_JOINT_SET_DEFAULT_EXT;
    if (XR_FAILED(runtime_.xr().CreateHandTrackerEXT(session_.handle(), &info, &trackers_[side])))
      trackers_[side] = XR_NULL_HANDLE;
  }
}

Status Inputs::sync(DeviceState& state) {
  state = {};
  if (set_ == XR_NULL_HANDLE || !session_.running()) return {};
  const XrActiveActionSet active{set_, XR_NULL_PATH};
  XrActionsSyncInfo info{XR_TYPE_ACTIONS_SYNC_INFO};
  info.countActiveActionSets = 1;
  info.activeActionSets = &active;
  const XrResult synced = runtime_.xr().SyncActions(session_.handle(), &info);
  NERITIC_TRY_STATUS(runtime_.check(synced, "xrSyncActions"));
  if (synced == XR_SESSION_NOT_FOCUSED) {
    // The wearer may hold a control for another program: it counts as held until it is let go.
    for (ControlAction& one : controls_) one.held = true;
    return {};
  }
  for (ControlAction& one : controls_) {
    XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO};
    get.action = one.action;
    XrActionStateFloat value{XR_TYPE_ACTION_STATE_FLOAT};
    NERITIC_TRY_STATUS(
        runtime_.check(runtime_.xr().GetActionStateFloat(session_.handle(), &get, &value),
                       "xrGetActionStateFloat"));
    const double now = value.isActive ? one.sign * double{value.currentState} : 0.0;
    const bool held = !value.isActive || now > kPressed;
    state.value[one.control] = now;
    if (held && !one.held) state.presses[one.control] = 1;
    one.held = held;
  }
  return {};
}

std::optional<Pose> Inputs::tracked_hand(std::size_t side, XrTime at) const {
  if (trackers_[side] == XR_NULL_HANDLE) return {};
  XrHandJointLocationEXT joints[XR_HAND_JOINT_COUNT_EXT];
  XrHandJointLocationsEXT locations{XR_TYPE_HAND_JOINT_LOCATIONS_EXT};
  locations.jointCount = XR_HAND_JOINT_COUNT_EXT;
  locations.jointLocations = joints;
  XrHandJointsLocateInfoEXT info{XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT};
  info.baseSpace = session_.stage();
  info.time = at;
  constexpr XrSpaceLocationFlags kKnown =
      XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
  if (XR_FAILED(runtime_.xr().LocateHandJointsEXT(trackers_[side], &info, &locations)) ||
      !locations.isActive || (joints[XR_HAND_JOINT_WRIST_EXT].locationFlags & kKnown) != kKnown)
    return {};
  Pose wrist = to_pose(joints[XR_HAND_JOINT_WRIST_EXT].pose);
  wrist.rotation = wrist.rotation * wrist_from_ours(side == 1);
  return wrist;
}

std::optional<Pose> Inputs::held_controller(std::size_t side, XrTime at) const {
  XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO};
  get.action = grips_[side];
  XrActionStatePose state{XR_TYPE_ACTION_STATE_POSE};
  XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
  constexpr XrSpaceLocationFlags kKnown =
      XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
  if (XR_FAILED(runtime_.xr().GetActionStatePose(session_.handle(), &get, &state)) ||
      !state.isActive ||
      XR_FAILED(runtime_.xr().LocateSpace(grip_spaces_[side], session_.stage(), at, &location)) ||
      (location.locationFlags & kKnown) != kKnown)
    return {};
  return to_pose(location.pose) * kGripFromWrist;
}

// Nothing while the tracker only infers where the eyes look.
void Inputs::read_gaze(XrTime at, Tracked& tracked) const {
  if (gaze_ == XR_NULL_HANDLE) return;
  XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO};
  get.action = gaze_;
  XrActionStatePose state{XR_TYPE_ACTION_STATE_POSE};
  XrEyeGazeSampleTimeEXT sampled{XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT};
  XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, &sampled};
  constexpr XrSpaceLocationFlags kMeasured =
      XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;
  if (XR_FAILED(runtime_.xr().GetActionStatePose(session_.handle(), &get, &state)) ||
      !state.isActive ||
      XR_FAILED(runtime_.xr().LocateSpace(gaze_space_, session_.stage(), at, &location)) ||
      (location.locationFlags & kMeasured) != kMeasured || sampled.time <= 0)
    return;
  tracked.gaze = {to_pose(location.pose), runtime_.to_host(sampled.time)};
}

void Inputs::track(XrTime at, Tracked& tracked) const {
  tracked = {};
  if (set_ == XR_NULL_HANDLE) return;
  for (std::size_t side = 0; side < 2; ++side) {
    tracked.hands[side] = tracked_hand(side, at);
    if (!tracked.hands[side]) tracked.hands[side] = held_controller(side, at);
  }
  read_gaze(at, tracked);
}

}  // namespace neritic::xr::openxr
