#include "tests/fakes/openxr/profiles.hpp"

#include <openxr/openxr.h>

#include <algorithm>

namespace neritic::fakes {
namespace {

constexpr std::string_view kLeft = "/user/hand/left", kRight = "/user/hand/right";

const std::vector<Profile>& profiles() {
  static const std::vector<Profile> all{
      {"/interaction_profiles/khr/simple_controller",
       "",
       {kLeft, kRight},
       {"input/select/click", "input/menu/click", "input/grip/pose", "input/aim/pose",
        "output/haptic"},
       {},
       {}},
      {"/interaction_profiles/oculus/touch_controller",
       "",
       {kLeft, kRight},
       {"input/squeeze/value", "input/trigger/value", "input/trigger/touch", "input/thumbstick/x",
        "input/thumbstick/y", "input/thumbstick/click", "input/thumbstick/touch",
        "input/thumbrest/touch", "input/grip/pose", "input/aim/pose", "output/haptic"},
       {"input/x/click", "input/x/touch", "input/y/click", "input/y/touch", "input/menu/click"},
       {"input/a/click", "input/a/touch", "input/b/click", "input/b/touch", "input/system/click"}},
      {"/interaction_profiles/valve/index_controller",
       "",
       {kLeft, kRight},
       {"input/system/click",   "input/system/touch",     "input/a/click",
        "input/a/touch",        "input/b/click",          "input/b/touch",
        "input/squeeze/value",  "input/squeeze/force",    "input/trigger/click",
        "input/trigger/value",  "input/trigger/touch",    "input/thumbstick/x",
        "input/thumbstick/y",   "input/thumbstick/click", "input/thumbstick/touch",
        "input/trackpad/x",     "input/trackpad/y",       "input/trackpad/force",
        "input/trackpad/touch", "input/grip/pose",        "input/aim/pose",
        "output/haptic"},
       {},
       {}},
      {"/interaction_profiles/htc/vive_controller",
       "",
       {kLeft, kRight},
       {"input/system/click", "input/squeeze/click", "input/menu/click", "input/trigger/click",
        "input/trigger/value", "input/trackpad/x", "input/trackpad/y", "input/trackpad/click",
        "input/trackpad/touch", "input/grip/pose", "input/aim/pose", "output/haptic"},
       {},
       {}},
      {"/interaction_profiles/microsoft/motion_controller",
       "",
       {kLeft, kRight},
       {"input/menu/click", "input/squeeze/click", "input/trigger/value", "input/thumbstick/x",
        "input/thumbstick/y", "input/thumbstick/click", "input/trackpad/x", "input/trackpad/y",
        "input/trackpad/click", "input/trackpad/touch", "input/grip/pose", "input/aim/pose",
        "output/haptic"},
       {},
       {}},
      {"/interaction_profiles/google/daydream_controller",
       "",
       {kLeft, kRight},
       {"input/select/click", "input/trackpad/x", "input/trackpad/y", "input/trackpad/click",
        "input/trackpad/touch", "input/grip/pose", "input/aim/pose"},
       {},
       {}},
      {"/interaction_profiles/oculus/go_controller",
       "",
       {kLeft, kRight},
       {"input/system/click", "input/trigger/click", "input/back/click", "input/trackpad/x",
        "input/trackpad/y", "input/trackpad/click", "input/trackpad/touch", "input/grip/pose",
        "input/aim/pose"},
       {},
       {}},
      {"/interaction_profiles/htc/vive_pro",
       "",
       {"/user/head"},
       {"input/system/click", "input/volume_up/click", "input/volume_down/click",
        "input/mute_mic/click"},
       {},
       {}},
      {"/interaction_profiles/microsoft/xbox_controller",
       "",
       {"/user/gamepad"},
       {"input/menu/click",
        "input/view/click",
        "input/a/click",
        "input/b/click",
        "input/x/click",
        "input/y/click",
        "input/dpad_down/click",
        "input/dpad_right/click",
        "input/dpad_up/click",
        "input/dpad_left/click",
        "input/shoulder_left/click",
        "input/shoulder_right/click",
        "input/thumbstick_left/x",
        "input/thumbstick_left/y",
        "input/thumbstick_left/click",
        "input/thumbstick_right/x",
        "input/thumbstick_right/y",
        "input/thumbstick_right/click",
        "input/trigger_left/value",
        "input/trigger_right/value",
        "output/haptic_left",
        "output/haptic_right",
        "output/haptic_left_trigger",
        "output/haptic_right_trigger"},
       {},
       {}},
      {"/interaction_profiles/ext/eye_gaze_interaction",
       XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME,
       {"/user/eyes_ext"},
       {"input/gaze_ext/pose"},
       {},
       {}}};
  return all;
}

InputKind kind_of(std::string_view component) {
  const auto ends = [&](std::string_view end) { return component.ends_with(end); };
  if (component.starts_with("output/")) return InputKind::kHaptic;
  if (ends("/pose")) return InputKind::kPose;
  if (ends("/click") || ends("/touch")) return InputKind::kBoolean;
  return InputKind::kFloat;
}

}  // namespace

const Profile* find_profile(std::string_view path) {
  for (const Profile& one : profiles()) {
    if (one.path == path) return &one;
  }
  return nullptr;
}

bool is_top(std::string_view path) {
  static constexpr std::string_view kTops[] = {
      kLeft, kRight, "/user/head", "/user/gamepad", "/user/treadmill", "/user/eyes_ext"};
  return std::find(std::begin(kTops), std::end(kTops), path) != std::end(kTops);
}

std::string top_of(std::string_view path) {
  for (std::size_t end = path.find('/', 1); end != std::string_view::npos;
       end = path.find('/', end + 1)) {
    if (is_top(path.substr(0, end))) return std::string(path.substr(0, end));
  }
  return "";
}

Resolved resolve(const Profile& profile, const std::string& path) {
  const std::string top = top_of(path);
  if (std::find(profile.tops.begin(), profile.tops.end(), top) == profile.tops.end()) return {};
  const std::string wanted = path.substr(top.size() + 1);
  std::vector<std::string_view> components = profile.both;
  const auto& own = top == kLeft ? profile.left : profile.right;
  if (top == kLeft || top == kRight) components.insert(components.end(), own.begin(), own.end());
  const auto has = [&](const std::string& component) {
    return std::find(components.begin(), components.end(), component) != components.end();
  };
  if (has(wanted)) return {kind_of(wanted), path};
  if (has(wanted + "/x") && has(wanted + "/y")) return {InputKind::kVector2, path};
  for (const char* end : {"/value", "/force", "/click", "/pose"}) {
    if (has(wanted + end)) return {kind_of(wanted + end), path + end};
  }
  return {};
}

}  // namespace neritic::fakes
