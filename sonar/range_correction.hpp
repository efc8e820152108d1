// Heard over true range where sound speed varies with depth, and where a bent ray leaves: tables
// over true range and the sine of the elevation above the horizon, which the gather interpolates.
// Any thread; a cache has one owner.
#pragma once

#include <optional>
#include <vector>

#include "engine/scene/sonar_settings.hpp"
#include "sonar/sound_speed_profile.hpp"

namespace neritic::sonar {

struct RangeCorrection {
  // [height][width]: row j at sine -1 + 2 j / (height - 1), column i at range i / (width - 1) of
  // the longest.
  std::uint32_t width = 0, height = 0;
  std::vector<float> factors;
  // Bent rays alone: by how much higher than straight at the point its ray leaves, radians.
  std::vector<float> bends;
};

// assumed_speed_m_s: what the sonar turns time to range with. Straight rays: the exact time along
// the straight path. Bent rays: along the ray that ends at the same point, found by iteration;
// where no ray comes within a thousandth of the range (a shadow zone) the straight path's time
// stands, and no bend. Along a bent ray nothing is looked at: what hides what
// is as with straight rays. A profile that the settings' reader has accepted. Sizes, at least 2
// each: what interpolation in them is off by say the rows "profile's table" of sonar/TRADE.md.
struct RangeCorrectionSize {
  std::uint32_t ranges = 33, sines = 65;
};
// mirror: of a ghost's legs, which are seen as if they went on beyond it.
struct ProfileMirror {
  double depth_m = 0.0;
  bool water_below = true;
  bool operator==(const ProfileMirror&) const = default;
};
RangeCorrection range_correction(const scene::SonarProfile& profile, double launch_depth_m,
                                 double range_max_m, double assumed_speed_m_s,
                                 RangeCorrectionSize size = {},
                                 const std::optional<ProfileMirror>& mirror = {});

// No ray of the profile leaves by more beside the straight line to a point within range_max_m: by
// the curvature, and by what Snell's law lets a direction change at all.
double most_bend_rad(const scene::SonarProfile& profile, double range_max_m);

// The profile with only the rows it takes to be within tolerance_m_s of all of them (Douglas and
// Peucker 1973), and with at most kMostRows: the tolerance doubles until it is so.
inline constexpr std::size_t kMostRows = 256;
SonarTable simplified(const SonarTable& profile, double tolerance_m_s = 0.01);

// The tables of a head (and of one mirror, where named), which go by its depth alone: made anew
// only where that changes by kDepthStep_m (whatever the order of pings, a depth has one table).
class RangeCorrections {
 public:
  static constexpr double kDepthStep_m = 0.05;
  // For an assumed speed of 1 m/s: factors are proportional to it.
  const RangeCorrection& at(const scene::SonarProfile& profile, double launch_depth_m,
                            double range_max_m, const std::optional<ProfileMirror>& mirror = {});
  std::size_t made() const { return made_; }  // so far

 private:
  scene::SonarProfile given_, used_;
  std::optional<ProfileMirror> mirror_;
  double depth_m_ = 0.0, range_max_m_ = 0.0;
  RangeCorrection table_;
  std::size_t made_ = 0;
};

}  // namespace neritic::sonar
