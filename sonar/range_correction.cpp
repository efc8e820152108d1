#include "sonar/range_correction.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/math.hpp"
#include "sonar/sound_speed_profile.hpp"

namespace neritic::sonar {
namespace {

// Travel time of the bent ray from the launch to a point at range r and elevation (straight).
double bent_time_s(const SoundSpeedProfile& profile, double launch_depth_m, double elevation_rad,
                   double r) {
  const double straight_s = profile.straight_time_s(launch_depth_m, elevation_rad, r);
  double launch_rad = elevation_rad, time_s = straight_s;
  constexpr double kHalf = kPi / 2.0;
  for (int i = 0; i < 12; ++i) {
    const RayPoint at = profile.bent(launch_depth_m, launch_rad, time_s);
    const double up = launch_depth_m - at.depth_m;
    const double reached = std::hypot(at.horizontal_m, up);
    const double off_rad = elevation_rad - std::atan2(up, at.horizontal_m);
    if (std::abs(off_rad) < 1e-9 && std::abs(reached - r) < 1e-9 * r) return time_s;
    launch_rad = std::clamp(launch_rad + off_rad, -kHalf, kHalf);
    time_s *= r / std::max(reached, 0.1 * r);
  }
  const RayPoint at = profile.bent(launch_depth_m, launch_rad, time_s);
  const double miss = std::hypot(at.horizontal_m - r * std::cos(elevation_rad),
                                 launch_depth_m - at.depth_m - r * std::sin(elevation_rad));
  return miss < 1e-3 * r ? time_s : straight_s;
}

}  // namespace

RangeCorrection range_correction(const scene::SonarProfile& settings, double launch_depth_m,
                                 double range_max_m, double assumed_speed_m_s,
                                 RangeCorrectionSize size) {
  Table rows;
  for (const auto& [depth_m, speed] : settings.table) rows.push_back({depth_m, speed});
  const auto made = SoundSpeedProfile::of_table(std::move(rows));
  NERITIC_CHECK(made.ok(), "sound speed profile: {}", made.ok() ? "" : made.error().message);
  const SoundSpeedProfile& profile = *made;
  RangeCorrection out{size.ranges, size.sines, {}};
  for (std::uint32_t j = 0; j < size.sines; ++j) {
    const double elevation = std::asin(std::clamp(-1.0 + 2.0 * j / (size.sines - 1), -1.0, 1.0));
    for (std::uint32_t i = 0; i < size.ranges; ++i) {
      const double r = std::max(range_max_m * i / (size.ranges - 1), 1e-6 * range_max_m);
      const double time_s = settings.bent ? bent_time_s(profile, launch_depth_m, elevation, r)
                                          : profile.straight_time_s(launch_depth_m, elevation, r);
      out.factors.push_back(static_cast<float>(assumed_speed_m_s * time_s / r));
    }
  }
  return out;
}

}  // namespace neritic::sonar
