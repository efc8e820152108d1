// The actions of the user of `dive`: their table with the controls of each, and their values
// in one frame. Plain values.
#pragma once

#include <vector>

#include "engine/core/math.hpp"
#include "engine/xr/actions.hpp"

namespace neritic::testbed {

// Since the last frame.
struct DiveInput {
  Vec3 move{0.0};            // x starboard, y up, z backwards; each -1 to 1
  std::uint64_t jacket = 0;  // buttons that are held: diver::kInflate, kDeflate
  double turn = 0.0;         // of a vehicle: to starboard 1, to port -1
  bool fast = false;
  Vec2 look_px{0.0};    // the mouse while it drags; x to the right, y down
  Vec2 look_rate{0.0};  // a stick, each -1 to 1; x to the right, y down
  double wheel = 0.0;   // clicks, positive away from the user
  bool toggle_help = false, toggle_panels = false, screenshot = false, reset = false;
  bool cycle_hud = false, toggle_times = false, next_sonar = false;
  bool toggle_pilot = false, quit = false;
  bool toggle_pause = false, step_frame = false;
  int faster = 0;                                      // steps of speed up; negative: down
  bool save = false, go_back = false, record = false;  // the run's state and recording
  bool toggle_graphs = false, toggle_map = false, next_inset = false, next_lamps = false;
  bool panel_screenshot = false, next_range = false;
  int gain_step = 0;  // of the sonars' pictures
  int view_step = 0;  // viewpoints on; negative: back
};

// The table that a display is made with.
std::vector<xr::ActionDesc> dive_actions();
DiveInput read_input(const xr::ActionValues& values);
// A person's input with what another asks for beside: commands about the run, panels, sonars, lamps
// and who steers. What moves the person or the view is the person's alone.
DiveInput with_commands(DiveInput input, const DiveInput& beside);

}  // namespace neritic::testbed
