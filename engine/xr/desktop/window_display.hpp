// The common part of the two displays of a desktop window. Rendering thread.
#pragma once

#include "engine/xr/display.hpp"

namespace neritic::xr {

struct DesktopOptions {
  std::uint32_t frames_in_flight = 2;
  double vertical_fov_rad = radians(60.0);  // whatever the window's size
};

class WindowDisplay : public Display {
 public:
  // Whether begin_frame waits for the window, as at first. Else, where something else paces the
  // frames, they are hidden while the window takes no picture.
  void set_waits(bool waits) { waits_ = waits; }
  // After begin_frame, for this frame: its layers are seen by that view, not by one straight ahead.
  void show(const View& view) { group_.views = {view}; }

 protected:
  ViewGroup group_;  // of this frame, one view
  bool waits_ = true;
};

}  // namespace neritic::xr
