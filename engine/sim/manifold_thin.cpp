// Many touch points of one surface, thinned to the few that say the same.
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "engine/sim/manifold.hpp"
#include "engine/sim/plane_axes.hpp"

namespace neritic::sim {
namespace {

// Eight directions in a plane, none of them along an axis.
constexpr std::size_t kDirections = 8;
std::array<Vec2, kDirections> spread_directions() {
  std::array<Vec2, kDirections> directions;
  for (std::size_t k = 0; k < kDirections; ++k) {
    const double angle_rad = 0.2 + static_cast<double>(k) * (2.0 * kPi / kDirections);
    directions[k] = Vec2(std::cos(angle_rad), std::sin(angle_rad));
  }
  return directions;
}

// The outermost of the group in each direction, and the deepest where it is deeper than those by
// more than rounding. Ties go to the first.
void keep_outermost(std::span<const TouchPoint> points, std::span<const std::size_t> group,
                    const std::array<Vec2, kDirections>& directions, std::vector<char>& keep) {
  constexpr double kTie_m = 1e-9, kDeeper_m = 1e-7;
  const PlaneAxes axes = plane_axes(points[group[0]].normal);
  std::array<std::size_t, kDirections> outermost;
  outermost.fill(group[0]);
  std::array<double, kDirections> farthest_m;
  farthest_m.fill(-std::numeric_limits<double>::infinity());
  std::size_t deepest = group[0];
  for (const std::size_t i : group) {
    const Vec2 at(glm::dot(axes.x, points[i].point_m), glm::dot(axes.y, points[i].point_m));
    for (std::size_t k = 0; k < kDirections; ++k) {
      const double far_m = glm::dot(directions[k], at);
      if (far_m > farthest_m[k] + kTie_m) farthest_m[k] = far_m, outermost[k] = i;
    }
    if (points[i].gap_m < points[deepest].gap_m) deepest = i;
  }
  double deepest_kept_m = std::numeric_limits<double>::infinity();
  for (const std::size_t i : outermost) {
    keep[i] = true;
    deepest_kept_m = std::min(deepest_kept_m, points[i].gap_m);
  }
  if (points[deepest].gap_m < deepest_kept_m - kDeeper_m) keep[deepest] = true;
}

// Among points at one place with all but the same normal, as where surfaces overlap, the deepest
// stays: more would say the same and only slow the solver down.
void drop_doubles(std::span<const TouchPoint> points, std::vector<char>& keep) {
  constexpr double kSamePlace_m = 1e-3, kAlike = 1e-4;  // 14 mrad
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; keep[i] && j < points.size(); ++j) {
      if (!keep[j] || glm::dot(points[i].normal, points[j].normal) < 1.0 - kAlike) continue;
      const Vec3 apart_m = points[i].point_m - points[j].point_m;
      if (glm::dot(apart_m, apart_m) > kSamePlace_m * kSamePlace_m) continue;
      keep[points[i].gap_m <= points[j].gap_m ? j : i] = false;
    }
}

}  // namespace

void thin_touch_points(std::vector<TouchPoint>& points, std::size_t from, ThinMemory& memory) {
  const std::span<const TouchPoint> own(points.data() + from, points.size() - from);
  if (own.size() <= 1) return;
  const auto directions = spread_directions();
  auto& [seen, keep, group] = memory;
  seen.assign(own.size(), false);
  keep.assign(own.size(), false);
  for (std::size_t first = 0; first < own.size(); ++first) {
    if (seen[first]) continue;
    group.clear();
    for (std::size_t i = first; i < own.size(); ++i) {
      if (seen[i] || glm::dot(own[i].normal, own[first].normal) < 1.0 - kSameDirection) continue;
      seen[i] = true;
      group.push_back(i);
    }
    keep_outermost(own, group, directions, keep);
  }
  drop_doubles(own, keep);
  std::size_t kept = from;
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) points[kept++] = points[from + i];
  points.resize(kept);
}

}  // namespace neritic::sim
