// Inside engine/xr/openxr only: which parts of which controllers give the controls of
// engine/xr/actions.hpp: those of "left" and "right", the hands' controllers, and of "pad", a
// gamepad. The user's table binds actions to the controls; a runtime may let him swap the parts.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace neritic::xr::openxr {

// A part of a controller: OpenXR's path, and the control that it moves.
struct ControlPart {
  std::string control;  // "left trigger"
  std::string path;     // "/user/hand/left/input/trigger/value"
  double sign = 1.0;    // OpenXR's sticks are positive upwards, the controls downwards
};
struct InteractionProfile {
  const char* path;  // "/interaction_profiles/khr/simple_controller"
  std::vector<ControlPart> parts;
  bool hands = false;  // it has grip poses
};
// OpenXR 1.0, section 6.4: simple, Touch, Index, Vive, Xbox.
std::vector<InteractionProfile> interaction_profiles();

}  // namespace neritic::xr::openxr
