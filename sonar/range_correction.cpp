#include "sonar/range_correction.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/math.hpp"
#include "sonar/sound_speed_profile.hpp"

namespace neritic::sonar {
namespace {

// The bent ray from the launch to a point at range r and elevation (straight).
struct BentRay {
  double time_s, launch_rad;
};
BentRay bent_ray(const SoundSpeedProfile& profile, double launch_depth_m, double elevation_rad,
                 double r) {
  const double straight_s = profile.straight_time_s(launch_depth_m, elevation_rad, r);
  double launch_rad = elevation_rad, time_s = straight_s;
  constexpr double kHalf = kPi / 2.0;
  for (int i = 0; i < 12; ++i) {
    const RayPoint at = profile.bent(launch_depth_m, launch_rad, time_s);
    const double up = launch_depth_m - at.depth_m;
    const double reached = std::hypot(at.horizontal_m, up);
    const double off_rad = elevation_rad - std::atan2(up, at.horizontal_m);
    if (std::abs(off_rad) < 1e-9 && std::abs(reached - r) < 1e-9 * r) return {time_s, launch_rad};
    launch_rad = std::clamp(launch_rad + off_rad, -kHalf, kHalf);
    time_s *= r / std::max(reached, 0.1 * r);
  }
  const RayPoint at = profile.bent(launch_depth_m, launch_rad, time_s);
  const double miss = std::hypot(at.horizontal_m - r * std::cos(elevation_rad),
                                 launch_depth_m - at.depth_m - r * std::sin(elevation_rad));
  if (miss < 1e-3 * r) return {time_s, launch_rad};
  return {straight_s, elevation_rad};
}

// Indices of rows kept between first and last, both of which are: the farthest from the chord stays
// as long as it is farther than the tolerance.
void keep_rows(const SonarTable& rows, double tolerance_m_s, std::vector<bool>& kept) {
  std::vector<std::pair<std::size_t, std::size_t>> spans{{0, rows.size() - 1}};
  kept[0] = kept[rows.size() - 1] = true;
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    const auto &a = rows[first], &b = rows[last];
    std::size_t worst = first;
    double most = tolerance_m_s;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double chord = a.y + (b.y - a.y) * (rows[i].x - a.x) / (b.x - a.x);
      if (std::abs(rows[i].y - chord) > most) most = std::abs(rows[i].y - chord), worst = i;
    }
    if (worst == first) continue;
    kept[worst] = true;
    spans.push_back({first, worst});
    spans.push_back({worst, last});
  }
}

}  // namespace

double most_bend_rad(const scene::SonarProfile& profile, double range_max_m) {
  const SonarTable& rows = profile.table;
  double steepest_s = 0.0, slowest = rows[0].y, fastest = rows[0].y;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    steepest_s =
        std::max(steepest_s, std::abs((rows[i].y - rows[i - 1].y) / (rows[i].x - rows[i - 1].x)));
    slowest = std::min(slowest, rows[i].y);
    fastest = std::max(fastest, rows[i].y);
  }
  // A curve of at most that curvature leaves its chord by at most an arc's half angle.
  const double half_turn = std::asin(std::min(1.0, 0.5 * range_max_m * steepest_s / slowest));
  return std::min(half_turn, 2.0 * std::acos(slowest / fastest));
}

SonarTable simplified(const SonarTable& profile, double tolerance_m_s) {
  if (profile.size() < 3) return profile;
  for (;; tolerance_m_s *= 2.0) {
    std::vector<bool> kept(profile.size(), false);
    keep_rows(profile, tolerance_m_s, kept);
    SonarTable out;
    for (std::size_t i = 0; i < profile.size(); ++i)
      if (kept[i]) out.push_back(profile[i]);
    if (out.size() <= kMostRows) return out;
  }
}

const RangeCorrection& RangeCorrections::at(const scene::SonarProfile& profile,
                                            double launch_depth_m, double range_max_m,
                                            const std::optional<ProfileMirror>& mirror) {
  const double depth_m = std::round(launch_depth_m / kDepthStep_m) * kDepthStep_m;
  const bool same = made_ > 0 && given_ == profile && mirror_ == mirror;
  if (same && depth_m == depth_m_ && range_max_m == range_max_m_) return table_;
  if (!same) {
    given_ = profile;
    mirror_ = mirror;
    used_ = {simplified(profile.table), profile.bent};
  }
  depth_m_ = depth_m;
  range_max_m_ = range_max_m;
  table_ = range_correction(used_, depth_m, range_max_m, 1.0, {}, mirror);
  ++made_;
  return table_;
}

RangeCorrection range_correction(const scene::SonarProfile& settings, double launch_depth_m,
                                 double range_max_m, double assumed_speed_m_s,
                                 RangeCorrectionSize size,
                                 const std::optional<ProfileMirror>& mirror) {
  const auto made = SoundSpeedProfile::of_table(settings.table);
  NERITIC_CHECK(made.ok(), "sound speed profile: {}", made.ok() ? "" : made.error().message);
  const SoundSpeedProfile profile =
      mirror ? made->beyond_mirror(mirror->depth_m, mirror->water_below) : *made;
  RangeCorrection out{size.ranges, size.sines, {}, {}};
  for (std::uint32_t j = 0; j < size.sines; ++j) {
    const double elevation = std::asin(std::clamp(-1.0 + 2.0 * j / (size.sines - 1), -1.0, 1.0));
    for (std::uint32_t i = 0; i < size.ranges; ++i) {
      const double r = std::max(range_max_m * i / (size.ranges - 1), 1e-6 * range_max_m);
      BentRay ray{0.0, elevation};
      if (settings.bent)
        ray = bent_ray(profile, launch_depth_m, elevation, r);
      else
        ray.time_s = profile.straight_time_s(launch_depth_m, elevation, r);
      out.factors.push_back(static_cast<float>(assumed_speed_m_s * ray.time_s / r));
      if (settings.bent) out.bends.push_back(static_cast<float>(ray.launch_rad - elevation));
    }
  }
  return out;
}

}  // namespace neritic::sonar
