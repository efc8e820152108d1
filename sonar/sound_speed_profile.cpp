#include "sonar/sound_speed_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace neritic::sonar {
namespace {

constexpr TableLimits kSpeedLimits{-100.0, 12000.0, 100.0, 10000.0};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// log(1 + x) / x, 1 at 0.
double log1p_over(double x) {
  return x == 0.0 ? 1.0 : std::log1p(x) / x;
}

}  // namespace

SoundSpeedProfile::SoundSpeedProfile(SonarTable rows) : rows_(std::move(rows)) {
  layers_.push_back({-kInfinity, rows_.front().x, rows_.front().x, rows_.front().y, 0.0});
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    const SonarRow &a = rows_[i - 1], &b = rows_[i];
    layers_.push_back({a.x, b.x, a.x, a.y, (b.y - a.y) / (b.x - a.x)});
  }
  layers_.push_back({rows_.back().x, kInfinity, rows_.back().x, rows_.back().y, 0.0});
}

Result<SoundSpeedProfile> SoundSpeedProfile::of_table(SonarTable depth_speed) {
  NERITIC_TRY_STATUS(validate(depth_speed, "sound speed profile", kSpeedLimits));
  return SoundSpeedProfile(std::move(depth_speed));
}

SoundSpeedProfile SoundSpeedProfile::beyond_mirror(double mirror_depth_m, bool water_below) const {
  SonarTable rows{{mirror_depth_m, speed_m_s(mirror_depth_m)}};
  for (const SonarRow& row : rows_) {
    if (water_below ? row.x <= mirror_depth_m : row.x >= mirror_depth_m) continue;
    rows.push_back(row);
    rows.push_back({2.0 * mirror_depth_m - row.x, row.y});
  }
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  return SoundSpeedProfile(std::move(rows));
}

double SoundSpeedProfile::speed_m_s(double depth_m) const {
  return interpolate(rows_, depth_m);
}

std::size_t SoundSpeedProfile::layer_at(double depth_m) const {
  const auto above = std::upper_bound(rows_.begin(), rows_.end(), depth_m,
                                      [](double v, const SonarRow& row) { return v < row.x; });
  return static_cast<std::size_t>(above - rows_.begin());
}

// In a layer, c is linear along the ray: over ds from speed c1 to c2 = c1 (1 + x) the time is
// ds / c1 * log(1 + x) / x. No difference of nearly equal numbers, so flat rays and flat layers
// need no case of their own.
double SoundSpeedProfile::straight_time_s(double launch_depth_m, double elevation_rad,
                                          double range_m) const {
  const double sink = -std::sin(elevation_rad);  // metres of depth a metre of range
  if (std::isnan(launch_depth_m) || std::isnan(sink) || std::isnan(range_m))
    return launch_depth_m + sink + range_m;
  double depth = launch_depth_m, left = range_m, time = 0.0;
  for (std::size_t at = layer_at(depth); left > 0.0;) {
    const Layer& layer = layers_[at];
    const double edge = sink > 0.0 ? layer.bottom_m : layer.top_m;
    const double to_edge = sink == 0.0 ? kInfinity : (edge - depth) / sink;
    const bool leaves = to_edge < left;
    const double part = leaves ? to_edge : left;
    const double speed = layer.speed_at(depth);
    time += part / speed * log1p_over(layer.gradient_s * sink * part / speed);
    left -= part;
    if (!leaves) break;
    depth = edge;
    at += sink > 0.0 ? 1 : -1;
  }
  return time;
}

}  // namespace neritic::sonar
