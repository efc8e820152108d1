// The actions of the user of `dive`: their table with the controls of each, and their values
// in one frame. Plain values.
#pragma once

#include <vector>

#include "engine/core/math.hpp"
#include "engine/xr/actions.hpp"

namespace neritic::testbed {

// Since the last frame.
struct DiveInput {
  Vec3 move{0.0};     // x starboard, y up, z backwards; each -1 to 1
  double turn = 0.0;  // of a vehicle: to starboard 1, to port -1
  bool fast = false;
  Vec2 look_px{0.0};    // the mouse while it drags; x to the right, y down
  Vec2 look_rate{0.0};  // a stick, each -1 to 1; x to the right, y down
  double wheel = 0.0;   // clicks, positive away from the user
  bool toggle_help = false, toggle_panels = false, screenshot = false, reset = false;
  bool toggle_pilot = false, quit = false;
};

// The table that a display is made with.
std::vector<xr::ActionDesc> dive_actions();
DiveInput read_input(const xr::ActionValues& values);

}  // namespace neritic::testbed
