#include "engine/xr/openxr/bindings.hpp"

namespace neritic::xr::openxr {
namespace {

struct Part {
  const char* control;
  const char* path;
  double sign = 1.0;
};

// The same parts on both hands.
void add_hands(InteractionProfile& profile, std::initializer_list<Part> parts) {
  profile.hands = true;
  for (const std::string side : {"left", "right"})
    for (const Part& part : parts)
      profile.parts.push_back(
          {side + " " + part.control, "/user/hand/" + side + "/input/" + part.path, part.sign});
}

void add_at(InteractionProfile& profile, const std::string& device, const std::string& user,
            std::initializer_list<Part> parts) {
  for (const Part& part : parts)
    profile.parts.push_back({device + " " + part.control, user + "/input/" + part.path, part.sign});
}

InteractionProfile gamepad() {
  InteractionProfile pad{"/interaction_profiles/microsoft/xbox_controller", {}};
  add_at(pad, "pad", "/user/gamepad",
         {{"left_x", "thumbstick_left/x"},
          {"left_y", "thumbstick_left/y", -1.0},
          {"right_x", "thumbstick_right/x"},
          {"right_y", "thumbstick_right/y", -1.0},
          {"left_trigger", "trigger_left/value"},
          {"right_trigger", "trigger_right/value"},
          {"a", "a/click"},
          {"b", "b/click"},
          {"x", "x/click"},
          {"y", "y/click"},
          {"left_bumper", "shoulder_left/click"},
          {"right_bumper", "shoulder_right/click"},
          {"back", "view/click"},
          {"start", "menu/click"},
          {"up", "dpad_up/click"},
          {"right", "dpad_right/click"},
          {"down", "dpad_down/click"},
          {"left", "dpad_left/click"}});
  return pad;
}

}  // namespace

std::vector<InteractionProfile> interaction_profiles() {
  InteractionProfile simple{"/interaction_profiles/khr/simple_controller", {}};
  add_hands(simple, {{"trigger", "select/click"}, {"menu", "menu/click"}});

  InteractionProfile touch{"/interaction_profiles/oculus/touch_controller", {}};
  add_hands(touch, {{"stick_x", "thumbstick/x"},
                    {"stick_y", "thumbstick/y", -1.0},
                    {"stick", "thumbstick/click"},
                    {"trigger", "trigger/value"},
                    {"squeeze", "squeeze/value"}});
  add_at(touch, "left", "/user/hand/left",
         {{"lower", "x/click"}, {"upper", "y/click"}, {"menu", "menu/click"}});
  add_at(touch, "right", "/user/hand/right", {{"lower", "a/click"}, {"upper", "b/click"}});

  InteractionProfile index{"/interaction_profiles/valve/index_controller", {}};
  add_hands(index, {{"stick_x", "thumbstick/x"},
                    {"stick_y", "thumbstick/y", -1.0},
                    {"stick", "thumbstick/click"},
                    {"trigger", "trigger/value"},
                    {"squeeze", "squeeze/value"},
                    {"lower", "a/click"},
                    {"upper", "b/click"},
                    {"menu", "trackpad/force"}});

  InteractionProfile vive{"/interaction_profiles/htc/vive_controller", {}};
  add_hands(vive, {{"stick_x", "trackpad/x"},
                   {"stick_y", "trackpad/y", -1.0},
                   {"stick", "trackpad/click"},
                   {"trigger", "trigger/value"},
                   {"squeeze", "squeeze/click"},
                   {"menu", "menu/click"}});
  return {simple, touch, index, vive, gamepad()};
}

}  // namespace neritic::xr::openxr
