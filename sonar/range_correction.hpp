// Heard over true range where sound speed varies with depth: a table over true range and the sine
// of the elevation above the horizon, which the gather interpolates. Pure function; any thread.
#pragma once

#include <vector>

#include "engine/scene/sonar_settings.hpp"

namespace neritic::sonar {

struct RangeCorrection {
  // [height][width]: row j at sine -1 + 2 j / (height - 1), column i at range i / (width - 1) of
  // the longest.
  std::uint32_t width = 0, height = 0;
  std::vector<float> factors;
};

// assumed_speed_m_s: what the sonar turns time to range with. Straight rays: the exact time along
// the straight path. Bent rays: along the ray that ends at the same point, found by iteration;
// where no ray comes within a thousandth of the range (a shadow zone) the straight path's time
// stands. What a bent ray passes through on its way is not looked at: what hides what is as with
// straight rays. A profile that the settings' reader has accepted.
// Sizes: the default's interpolation is off by what sonar/README.md's section Trade says; at
// least 2.
struct RangeCorrectionSize {
  std::uint32_t ranges = 33, sines = 65;
};
RangeCorrection range_correction(const scene::SonarProfile& profile, double launch_depth_m,
                                 double range_max_m, double assumed_speed_m_s,
                                 RangeCorrectionSize size = {});

}  // namespace neritic::sonar
