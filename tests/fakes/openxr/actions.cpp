// Actions: their sets, suggested bindings, and values read from the script at each xrSyncActions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/fakes/openxr/profiles.hpp"
#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

void check_name(Call& call, const char* name, const char* localized) {
  const std::string one = name;
  call.require(!one.empty(), XR_ERROR_NAME_INVALID, "the name is empty");
  call.require(
      one.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_.") == std::string::npos,
      XR_ERROR_PATH_FORMAT_INVALID,
      "the name '" + one + "' has other characters than a to z, 0 to 9, - _ .");
  call.require(localized[0] != 0, XR_ERROR_LOCALIZED_NAME_INVALID, "the localized name is empty");
}

template <class T>
void check_unique(Call& call, const Object* parent, const char* name, const char* localized) {
  for (const auto& [handle, object] : call.rt.objects) {
    if (object->type != T::kObject || object->parent != parent) continue;
    const auto& other = static_cast<const T&>(*object);
    call.require(other.name != name, XR_ERROR_NAME_DUPLICATED,
                 fmt::format("the name '{}' is taken", name));
    call.require(other.localized != localized, XR_ERROR_LOCALIZED_NAME_DUPLICATED,
                 fmt::format("the localized name '{}' is taken", localized));
  }
}

XrResult create_set(Call& call, XrInstance handle, const XrActionSetCreateInfo* create,
                    XrActionSet* made) {
  Instance& instance = call.get<Instance>(handle);
  const auto& info = call.in(create);
  check_name(call, info.actionSetName, info.localizedActionSetName);
  check_unique<ActionSet>(call, &instance, info.actionSetName, info.localizedActionSetName);
  ActionSet& set = call.add<ActionSet>(&instance);
  set.name = info.actionSetName;
  set.localized = info.localizedActionSetName;
  *call.not_null(made, "the action set") = handle_of(set);
  return XR_SUCCESS;
}

XrResult destroy_set(Call& call, XrActionSet handle) {
  call.rt.destroy(call.get_to_destroy<ActionSet>(handle));
  return XR_SUCCESS;
}

XrResult create_action(Call& call, XrActionSet handle, const XrActionCreateInfo* create,
                       XrAction* made) {
  ActionSet& set = call.get<ActionSet>(handle);
  const auto& info = call.in(create);
  call.require(!set.attached, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED,
               "the action set is attached to a session; it can have no more actions");
  check_name(call, info.actionName, info.localizedActionName);
  check_unique<Action>(call, &set, info.actionName, info.localizedActionName);
  std::vector<std::string> subactions;
  for (std::uint32_t i = 0; i < info.countSubactionPaths; ++i) {
    const std::string path = call.path(info.subactionPaths[i]);
    call.require(is_top(path), XR_ERROR_PATH_UNSUPPORTED,
                 "the subaction path " + path + " is no top-level user path");
    call.require(std::find(subactions.begin(), subactions.end(), path) == subactions.end(),
                 XR_ERROR_PATH_UNSUPPORTED, "the subaction path " + path + " is given twice");
    subactions.push_back(path);
  }
  Action& action = call.add<Action>(&set);
  action.name = info.actionName;
  action.localized = info.localizedActionName;
  action.kind = info.actionType;
  action.subactions = std::move(subactions);
  *call.not_null(made, "the action") = handle_of(action);
  return XR_SUCCESS;
}

XrResult destroy_action(Call& call, XrAction handle) {
  call.rt.destroy(call.get_to_destroy<Action>(handle));
  return XR_SUCCESS;
}

// Booleans and floats convert into each other; a float may be one axis; nothing else does.
bool fits(XrActionType action, InputKind input) {
  switch (action) {
    case XR_ACTION_TYPE_BOOLEAN_INPUT:
    case XR_ACTION_TYPE_FLOAT_INPUT:
      return input == InputKind::kBoolean || input == InputKind::kFloat;
    case XR_ACTION_TYPE_VECTOR2F_INPUT:
      return input == InputKind::kVector2;
    case XR_ACTION_TYPE_POSE_INPUT:
      return input == InputKind::kPose;
    case XR_ACTION_TYPE_VIBRATION_OUTPUT:
      return input == InputKind::kHaptic;
    default:
      return false;
  }
}

XrResult suggest(Call& call, XrInstance handle,
                 const XrInteractionProfileSuggestedBinding* suggestion) {
  Instance& instance = call.get<Instance>(handle);
  const auto& info = call.in(suggestion);
  const std::string name = call.path(info.interactionProfile);
  const Profile* profile = find_profile(name);
  call.require(profile && call.enabled(profile->extension), XR_ERROR_PATH_UNSUPPORTED,
               name +
                   " is no interaction profile of the specification or its extension was not "
                   "enabled");
  call.require(info.countSuggestedBindings > 0, XR_ERROR_VALIDATION_FAILURE,
               "countSuggestedBindings is 0");
  std::map<std::uint64_t, std::vector<std::string>> bindings;
  for (std::uint32_t i = 0; i < info.countSuggestedBindings; ++i) {
    const XrActionSuggestedBinding& one = info.suggestedBindings[i];
    const Action& action = call.get<Action>(one.action);
    const std::string path = call.path(one.binding);
    call.require(!action.set.attached, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED,
                 "the action " + action.name + " is attached to a session already");
    const Resolved found = resolve(*profile, path);
    call.require(found.kind != InputKind::kNone, XR_ERROR_PATH_UNSUPPORTED,
                 path + " does not exist in " + name);
    call.require(fits(action.kind, found.kind), XR_ERROR_PATH_UNSUPPORTED,
                 fmt::format("the action {} cannot be bound to {}, which is of another kind",
                             action.name, path));
    bindings[action.handle].push_back(found.path);
  }
  instance.suggested[name] = std::move(bindings);
  return XR_SUCCESS;
}

XrResult attach(Call& call, XrSession handle, const XrSessionActionSetsAttachInfo* attach_info) {
  Session& session = call.get<Session>(handle);
  const auto& info = call.in(attach_info);
  call.require(!session.attached, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED,
               "action sets are attached to the session already");
  call.require(info.countActionSets > 0, XR_ERROR_VALIDATION_FAILURE, "countActionSets is 0");
  std::vector<std::uint64_t> sets;
  for (std::uint32_t i = 0; i < info.countActionSets; ++i) {
    ActionSet& set = call.get<ActionSet>(info.actionSets[i]);
    set.attached = true;
    sets.push_back(set.handle);
  }
  session.attached = true;
  session.action_sets = std::move(sets);
  return XR_SUCCESS;
}

// The controller that the person holds at a top-level path, if the client suggested bindings for
// it.
std::string current_profile(const Runtime& rt, const Instance& instance, const std::string& top) {
  const Script& script = rt.script;
  std::string profile;
  if (top == "/user/hand/left") profile = script.controllers[0].profile;
  if (top == "/user/hand/right") profile = script.controllers[1].profile;
  if (top == "/user/gamepad") profile = script.gamepad;
  if (top == "/user/eyes_ext" && !script.gaze.empty()) {
    profile = "/interaction_profiles/ext/eye_gaze_interaction";
  }
  return instance.suggested.contains(profile) ? profile : "";
}

// The paths that an action is bound to now, under one top-level path or all ("").
std::vector<std::string> bound_paths(const Runtime& rt, const Action& action,
                                     const std::string& top) {
  std::vector<std::string> paths;
  const Instance& instance = action.set.instance;
  for (const auto& [profile, bindings] : instance.suggested) {
    const auto found = bindings.find(action.handle);
    if (found == bindings.end()) continue;
    for (const std::string& path : found->second) {
      const std::string of = top_of(path);
      if ((top.empty() || of == top) && current_profile(rt, instance, of) == profile) {
        paths.push_back(path);
      }
    }
  }
  return paths;
}

std::array<double, 2> input_at(const Runtime& rt, const std::string& path) {
  const auto found = rt.script.inputs.find(path);
  if (found == rt.script.inputs.end()) return {0, 0};
  const auto* value = found->second.at(rt.seconds(rt.now));
  return value ? *value : std::array<double, 2>{0, 0};
}

// The largest of all bound inputs; a stick's two axes may be given as one input or as two.
ActionValue read_value(const Runtime& rt, const Action& action, const std::string& top) {
  ActionValue value;
  for (const std::string& path : bound_paths(rt, action, top)) {
    value.active = true;
    auto [x, y] = input_at(rt, path);
    if (action.kind == XR_ACTION_TYPE_VECTOR2F_INPUT && x == 0 && y == 0) {
      x = input_at(rt, path + "/x")[0];
      y = input_at(rt, path + "/y")[0];
    }
    if (std::hypot(x, y) > std::hypot(value.x, value.y)) value.x = x, value.y = y;
  }
  if (action.kind == XR_ACTION_TYPE_BOOLEAN_INPUT) value.x = value.x > 0.5;
  return value;
}

void tell_profiles(const Runtime& rt, Session& session) {
  bool changed = false;
  for (const char* top :
       {"/user/hand/left", "/user/hand/right", "/user/gamepad", "/user/eyes_ext"}) {
    const std::string now = current_profile(rt, session.instance, top);
    changed = changed || session.profile_told[top] != now;
    session.profile_told[top] = now;
  }
  XrEventDataInteractionProfileChanged event{};
  event.session = handle_of(session);
  if (changed) queue(session.instance, event);
}

void sync_action(const Runtime& rt, Session& session, const Action& action, bool active) {
  std::vector<std::string> tops = action.subactions;
  tops.emplace_back();
  for (const std::string& top : tops) {
    ActionValue& last = session.action_states[action.handle].by_top[top];
    ActionValue now = active ? read_value(rt, action, top) : ActionValue{};
    now.changed = now.active && last.active && (now.x != last.x || now.y != last.y);
    now.changed_at = now.changed ? rt.now : last.changed_at;
    last = now;
  }
}

XrResult sync(Call& call, XrSession handle, const XrActionsSyncInfo* sync_info) {
  Session& session = call.get<Session>(handle);
  const auto& info = call.in(sync_info);
  std::map<std::uint64_t, bool> active;
  for (std::uint32_t i = 0; i < info.countActiveActionSets; ++i) {
    const XrActiveActionSet& one = info.activeActionSets[i];
    const ActionSet& set = call.get<ActionSet>(one.actionSet);
    const auto& attached = session.action_sets;
    call.require(std::find(attached.begin(), attached.end(), set.handle) != attached.end(),
                 XR_ERROR_ACTIONSET_NOT_ATTACHED,
                 "the action set " + set.name + " is not attached to the session");
    if (one.subactionPath != XR_NULL_PATH) call.path(one.subactionPath);
    active[set.handle] = true;
  }
  const bool focused = session.state == XR_SESSION_STATE_FOCUSED;
  for (const auto& [id, object] : call.rt.objects) {
    if (object->type != XR_OBJECT_TYPE_ACTION) continue;
    const auto& action = static_cast<const Action&>(*object);
    sync_action(call.rt, session, action, focused && active.contains(action.set.handle));
  }
  if (session.attached) tell_profiles(call.rt, session);
  return focused ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}

const ActionValue& state_of(Call& call, XrSession handle, const XrActionStateGetInfo* get,
                            XrActionType kind) {
  Session& session = call.get<Session>(handle);
  const auto& info = call.in(get);
  const Action& action = call.get<Action>(info.action);
  if (!action.set.attached)
    call.fault(XR_ERROR_ACTIONSET_NOT_ATTACHED,
               "the action set of " + action.name + " is not attached to the session");
  if (action.kind != kind)
    call.fault(XR_ERROR_ACTION_TYPE_MISMATCH, "the action " + action.name + " is of another type");
  std::string top;
  if (info.subactionPath != XR_NULL_PATH) {
    top = call.path(info.subactionPath);
    const auto& tops = action.subactions;
    if (std::find(tops.begin(), tops.end(), top) == tops.end())
      call.fault(XR_ERROR_PATH_UNSUPPORTED,
                 "the action " + action.name + " was not made with the subaction path " + top);
  }
  return session.action_states[action.handle].by_top[top];
}

template <class State>
void put_state(const ActionValue& value, State& to) {
  to.isActive = value.active;
  to.changedSinceLastSync = value.changed;
  to.lastChangeTime = value.changed_at;
}

XrResult get_boolean(Call& call, XrSession session, const XrActionStateGetInfo* info,
                     XrActionStateBoolean* state) {
  const ActionValue& value = state_of(call, session, info, XR_ACTION_TYPE_BOOLEAN_INPUT);
  put_state(value, call.out(state));
  state->currentState = value.x != 0;
  return XR_SUCCESS;
}

XrResult get_float(Call& call, XrSession session, const XrActionStateGetInfo* info,
                   XrActionStateFloat* state) {
  const ActionValue& value = state_of(call, session, info, XR_ACTION_TYPE_FLOAT_INPUT);
  put_state(value, call.out(state));
  state->currentState = static_cast<float>(value.x);
  return XR_SUCCESS;
}

XrResult get_vector(Call& call, XrSession session, const XrActionStateGetInfo* info,
                    XrActionStateVector2f* state) {
  const ActionValue& value = state_of(call, session, info, XR_ACTION_TYPE_VECTOR2F_INPUT);
  put_state(value, call.out(state));
  state->currentState = {static_cast<float>(value.x), static_cast<float>(value.y)};
  return XR_SUCCESS;
}

XrResult get_pose(Call& call, XrSession session, const XrActionStateGetInfo* info,
                  XrActionStatePose* state) {
  const ActionValue& value = state_of(call, session, info, XR_ACTION_TYPE_POSE_INPUT);
  call.out(state).isActive = value.active;
  return XR_SUCCESS;
}

XrResult get_profile(Call& call, XrSession handle, XrPath top, XrInteractionProfileState* state) {
  Session& session = call.get<Session>(handle);
  const std::string path = call.path(top);
  call.require(is_top(path), XR_ERROR_PATH_UNSUPPORTED, path + " is no top-level user path");
  call.require(session.attached, XR_ERROR_ACTIONSET_NOT_ATTACHED,
               "no action sets are attached to the session");
  XrInteractionProfileState& to = call.out(state);
  const std::string& profile = session.profile_told[path];
  auto& paths = session.instance.paths;
  const auto found = std::find(paths.begin(), paths.end(), profile);
  to.interactionProfile = profile.empty() ? XR_NULL_PATH : (found - paths.begin()) + 1;
  return XR_SUCCESS;
}

XrResult bound_sources(Call& call, XrSession handle,
                       const XrBoundSourcesForActionEnumerateInfo* enumerate,
                       std::uint32_t capacity, std::uint32_t* count, XrPath* sources) {
  Session& session = call.get<Session>(handle);
  const Action& action = call.get<Action>(call.in(enumerate).action);
  call.require(action.set.attached, XR_ERROR_ACTIONSET_NOT_ATTACHED,
               "the action set of " + action.name + " is not attached to the session");
  std::vector<XrPath> found;
  auto& paths = session.instance.paths;
  for (const std::string& path : bound_paths(call.rt, action, "")) {
    auto at = std::find(paths.begin(), paths.end(), path);
    if (at == paths.end()) at = paths.insert(paths.end(), path);
    found.push_back(static_cast<XrPath>(at - paths.begin()) + 1);
  }
  call.fill(capacity, count, sources, found);
  return XR_SUCCESS;
}

XrResult localized_name(Call& call, XrSession handle, const XrInputSourceLocalizedNameGetInfo* get,
                        std::uint32_t capacity, std::uint32_t* count, char* text) {
  const Session& session = call.get<Session>(handle);
  const auto& info = call.in(get);
  call.require(session.attached, XR_ERROR_ACTIONSET_NOT_ATTACHED,
               "no action sets are attached to the session");
  call.require(info.whichComponents != 0, XR_ERROR_VALIDATION_FAILURE, "whichComponents is 0");
  std::string name = call.path(info.sourcePath);
  name.push_back('\0');
  call.fill(capacity, count, text, name);
  return XR_SUCCESS;
}

XrResult vibrate(Call& call, XrSession handle, const XrHapticActionInfo* action_info,
                 const XrHapticBaseHeader* haptic) {
  Session& session = call.get<Session>(handle);
  const auto& info = call.in(action_info);
  const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, info.action,
                                 info.subactionPath};
  state_of(call, handle, &get, XR_ACTION_TYPE_VIBRATION_OUTPUT);
  const auto& vibration = call.in(reinterpret_cast<const XrHapticVibration*>(haptic));
  call.require(vibration.amplitude >= 0 && vibration.amplitude <= 1, XR_ERROR_VALIDATION_FAILURE,
               fmt::format("the amplitude is {}; accepted: 0 to 1", vibration.amplitude));
  if (session.state != XR_SESSION_STATE_FOCUSED) return XR_SESSION_NOT_FOCUSED;
  call.rt.log.push_back(
      fmt::format("haptic {} {}", call.get<Action>(info.action).name, vibration.amplitude));
  return XR_SUCCESS;
}

XrResult stop_vibration(Call& call, XrSession handle, const XrHapticActionInfo* action_info) {
  const auto& info = call.in(action_info);
  const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, info.action,
                                 info.subactionPath};
  state_of(call, handle, &get, XR_ACTION_TYPE_VIBRATION_OUTPUT);
  return call.get<Session>(handle).state == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS
                                                                     : XR_SESSION_NOT_FOCUSED;
}

XrResult create_action_space(Call& call, XrSession handle, const XrActionSpaceCreateInfo* create,
                             XrSpace* made) {
  Session& session = call.get<Session>(handle);
  const auto& info = call.in(create);
  const Action& action = call.get<Action>(info.action);
  call.require(action.kind == XR_ACTION_TYPE_POSE_INPUT, XR_ERROR_ACTION_TYPE_MISMATCH,
               "the action " + action.name + " is no pose");
  call.check_pose(info.poseInActionSpace);
  Space& space = call.add<Space>(&session);
  space.action = action.handle;
  if (info.subactionPath != XR_NULL_PATH) space.top_path = call.path(info.subactionPath);
  space.offset = from_xr(info.poseInActionSpace);
  *call.not_null(made, "the space") = handle_of(space);
  return XR_SUCCESS;
}

}  // namespace

Located locate_action(Runtime& rt, const Space& space, XrTime time) {
  Located at;
  at.oriented = at.positioned = at.tracked = false;
  const auto found = rt.objects.find(space.action);
  if (found == rt.objects.end()) return at;
  const auto& action = static_cast<const Action&>(*found->second);
  const auto state = space.session.action_states.find(space.action);
  if (state == space.session.action_states.end() || !state->second.by_top[space.top_path].active) {
    return at;
  }
  for (const std::string& path : bound_paths(rt, action, space.top_path)) {
    if (path.starts_with("/user/eyes_ext")) return locate_gaze(rt, time);
    const PoseTrack& grip = rt.script.controllers[path.starts_with("/user/hand/right")].grip;
    if (grip.empty()) continue;
    at.pose = grip.at(rt.seconds(time));
    // The aim lies 5 cm before the grip.
    if (path.ends_with("/aim/pose")) at.pose = at.pose * Pose{{0, 0, -0.05}, {1, 0, 0, 0}};
    at.oriented = at.positioned = at.tracked = true;
    return at;
  }
  return at;
}

void add_action_functions(Table& table) {
  table.insert(table.end(), {NERITIC_XR_ROW(xrCreateActionSet, create_set, ""),
                             NERITIC_XR_ROW(xrDestroyActionSet, destroy_set, ""),
                             NERITIC_XR_ROW(xrCreateAction, create_action, ""),
                             NERITIC_XR_ROW(xrDestroyAction, destroy_action, ""),
                             NERITIC_XR_ROW(xrSuggestInteractionProfileBindings, suggest, ""),
                             NERITIC_XR_ROW(xrAttachSessionActionSets, attach, ""),
                             NERITIC_XR_ROW(xrSyncActions, sync, ""),
                             NERITIC_XR_ROW(xrGetActionStateBoolean, get_boolean, ""),
                             NERITIC_XR_ROW(xrGetActionStateFloat, get_float, ""),
                             NERITIC_XR_ROW(xrGetActionStateVector2f, get_vector, ""),
                             NERITIC_XR_ROW(xrGetActionStatePose, get_pose, ""),
                             NERITIC_XR_ROW(xrGetCurrentInteractionProfile, get_profile, ""),
                             NERITIC_XR_ROW(xrEnumerateBoundSourcesForAction, bound_sources, ""),
                             NERITIC_XR_ROW(xrGetInputSourceLocalizedName, localized_name, ""),
                             NERITIC_XR_ROW(xrApplyHapticFeedback, vibrate, ""),
                             NERITIC_XR_ROW(xrStopHapticFeedback, stop_vibration, ""),
                             NERITIC_XR_ROW(xrCreateActionSpace, create_action_space, "")});
}

}  // namespace neritic::fakes
