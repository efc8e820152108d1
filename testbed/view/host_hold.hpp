// For how long the newest input of a person at a screen holds without another: a time of the host,
// told as the scene's time that passes in it. Plain value; rendering thread.
#pragma once

#include <algorithm>

#include "engine/core/clock.hpp"

namespace neritic::testbed {

class HostHold {
 public:
  // Frames that send nothing for so long have let go (kDiverHold_s is of the same order); of slow
  // frames so many must be missing, and nobody waits longer than the last.
  static constexpr double kHold_s = 1.0, kFrames = 3.0, kLongest_s = 15.0;

  // A frame came, while so many seconds of the scene pass in one of the host. True: the hold has
  // changed, so what was claimed has to be claimed anew.
  bool frame(TimeNs now_ns, double speed) {
    const double before_s = scene_s();
    const double missing_s =
        taken_ns_ > 0 ? kFrames * 1e-9 * static_cast<double>(now_ns - taken_ns_) : 0.0;
    taken_ns_ = now_ns;
    if (missing_s > host_s_) host_s_ = std::min(1.5 * missing_s, kLongest_s);
    speed_ = speed;
    return scene_s() != before_s;
  }
  double scene_s() const { return host_s_ * speed_; }

 private:
  TimeNs taken_ns_ = 0;  // the newest frame; 0: none yet
  double host_s_ = kHold_s, speed_ = 1.0;
};

}  // namespace neritic::testbed
