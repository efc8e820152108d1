// Contact points of a part and a triangle.
#include "engine/sim/manifold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/sim/body_shape.hpp"
#include "engine/sim/convex_query.hpp"
#include "engine/sim/plane_axes.hpp"

namespace neritic::sim {
namespace {

// A polygon of a part's core in a plane, and heights over it. Left unset where there is no point:
// filling it would cost more than using it.
struct Flat {
  double x, y, height_m;
};
using FlatPolygon = std::array<Flat, kMaxCorePoints + 4>;

double cross_of(const Flat& o, const Flat& a, const Flat& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

// The convex hull of the first count points, counter-clockwise, in place (Andrew 1979). Returns its
// size.
std::size_t flat_hull(FlatPolygon& points, std::size_t count) {
  if (count < 3) return count;
  std::sort(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Flat& a, const Flat& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::array<Flat, 2 * kMaxCorePoints + 2> hull;
  std::size_t size = 0;
  const auto add = [&](const Flat& p, std::size_t floor) {
    while (size >= floor + 2 && cross_of(hull[size - 2], hull[size - 1], p) <= 0.0) --size;
    hull[size++] = p;
  };
  for (std::size_t i = 0; i < count; ++i) add(points[i], 0);
  const std::size_t lower = size - 1;
  for (std::size_t i = count - 1; i-- > 0;) add(points[i], lower);
  --size;  // the first again
  std::copy_n(hull.begin(), size, points.begin());
  return size;
}

// The part of the polygon (or segment, or point) to the left of the line from a to b.
std::size_t clip(const FlatPolygon& points, std::size_t count, const Flat& a, const Flat& b,
                 FlatPolygon& out) {
  std::size_t size = 0;
  const double length = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
  const auto side = [&](const Flat& p) { return cross_of(a, b, p) / length; };
  constexpr double kOnLine_m = 1e-9;
  for (std::size_t i = 0; i < count; ++i) {
    const Flat& here = points[i];
    const double here_side = side(here);
    if (here_side >= -kOnLine_m && size < out.size()) out[size++] = here;
    if (i + 1 == count && count < 3) break;  // a segment has one side
    const Flat& next = points[(i + 1) % count];
    const double next_side = side(next);
    if ((here_side < -kOnLine_m && next_side > kOnLine_m) ||
        (here_side > kOnLine_m && next_side < -kOnLine_m)) {
      const double share = here_side / (here_side - next_side);
      if (size < out.size())
        out[size++] = {here.x + (next.x - here.x) * share, here.y + (next.y - here.y) * share,
                       here.height_m + (next.height_m - here.height_m) * share};
    }
  }
  return size;
}

// The core's points that are no higher than limit over the plane, in the plane's axes.
std::size_t points_below(const PlacedPart& part, const Vec3& origin, const Vec3& normal,
                         const PlaneAxes& axes, double limit_m, FlatPolygon& out) {
  std::size_t count = 0;
  for (const Vec3& p : part.core_m) {
    const Vec3 from = p - origin;
    const double height_m = glm::dot(normal, from);
    if (height_m <= limit_m)
      out[count++] = {glm::dot(axes.x, from), glm::dot(axes.y, from), height_m};
  }
  return count;
}

// The face touches: corners of what the part's underside and the triangle have in common. Returns
// the lowest gap, infinite where there is nothing in common.
double add_face(const PlacedPart& part, const Triangle& triangle, const Vec3& normal,
                double margin_m, std::vector<TouchPoint>& out) {
  const Vec3& origin = triangle.corner[0];
  const PlaneAxes axes = plane_axes(normal);
  FlatPolygon polygon, clipped;
  std::size_t count = points_below(part, origin, normal, axes, part.radius_m + margin_m, polygon);
  count = flat_hull(polygon, count);
  std::array<Flat, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 from = triangle.corner[i] - origin;
    corners[i] = {glm::dot(axes.x, from), glm::dot(axes.y, from), 0.0};
  }
  if (cross_of(corners[0], corners[1], corners[2]) < 0.0) std::swap(corners[1], corners[2]);
  count = clip(polygon, count, corners[0], corners[1], clipped);
  count = clip(clipped, count, corners[1], corners[2], polygon);
  count = clip(polygon, count, corners[2], corners[0], clipped);
  double lowest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const double gap_m = clipped[i].height_m - part.radius_m;
    out.push_back(
        {origin + axes.x * clipped[i].x + axes.y * clipped[i].y, normal, gap_m, triangle.index});
    lowest_m = std::min(lowest_m, gap_m);
  }
  return lowest_m;
}

// The edge from a to b lies along the part's underside: the ends of what they have in common. False
// where they cross in one point.
bool add_edge(const PlacedPart& part, const Vec3& a, const Vec3& b, const Vec3& normal,
              double gap_m, std::uint32_t index, std::vector<TouchPoint>& out) {
  const Vec3 along = glm::normalize(b - a);
  const Vec3 side = glm::cross(normal, along);
  const PlaneAxes axes{along, side};
  FlatPolygon polygon;
  // The underside: what is within a hundredth of the part's size of its lowest point.
  const double lowest_m = gap_m + part.radius_m;
  const double slack_m = 0.01 * part.reach_m;
  const std::size_t found = points_below(part, a, normal, axes, lowest_m + slack_m, polygon);
  const std::size_t count = flat_hull(polygon, found);
  if (count < 2) return false;
  // Where the edge, which is the x axis, passes through the polygon.
  double from = std::numeric_limits<double>::infinity(), to = -from;
  Flat first{}, last{};
  const auto meet = [&](const Flat& p) {
    if (p.x < from) from = p.x, first = p;
    if (p.x > to) to = p.x, last = p;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Flat &p = polygon[i], &q = polygon[(i + 1) % count];
    constexpr double kOnEdge_m = 1e-9;
    if (std::abs(p.y) <= kOnEdge_m) meet(p);
    if ((p.y < 0.0) == (q.y < 0.0) || std::abs(q.y - p.y) <= kOnEdge_m) continue;
    const double share = p.y / (p.y - q.y);
    meet({p.x + (q.x - p.x) * share, 0.0, p.height_m + (q.height_m - p.height_m) * share});
  }
  const double length = glm::length(b - a);
  if (!(to - from > 1e-6) || to < 0.0 || from > length) return false;
  const auto add = [&](double x) {
    const double share = (x - from) / (to - from);
    const double height_m = first.height_m + (last.height_m - first.height_m) * share;
    out.push_back({a + along * x, normal, height_m - part.radius_m, index});
  };
  add(std::clamp(from, 0.0, length));
  add(std::clamp(to, 0.0, length));
  return true;
}

// The corners of the triangle that span the feature with the point: bit i for corner i.
unsigned feature_of(const Triangle& triangle, const Vec3& point) {
  const auto& [a, b, c] = triangle.corner;
  const Vec3 normal = triangle.area_normal();
  const double area = glm::dot(normal, normal);
  const double weights[3] = {glm::dot(glm::cross(c - b, point - b), normal) / area,
                             glm::dot(glm::cross(a - c, point - c), normal) / area,
                             glm::dot(glm::cross(b - a, point - a), normal) / area};
  unsigned feature = 0;
  for (unsigned i = 0; i < 3; ++i)
    if (weights[i] > 1e-7) feature |= 1u << i;
  return feature;
}

// A neighbour across one of the edges that meet the feature reaches farther towards the part: then
// the contact is the neighbour's.
bool hidden(const Triangle& triangle, unsigned feature, const Vec3& point, const Vec3& direction) {
  for (unsigned i = 0; i < 3; ++i) {
    const unsigned edge = 1u << i | 1u << (i + 1) % 3;
    if ((feature & ~edge) != 0 || !triangle.shared[i]) continue;
    const Vec3 towards = triangle.across[i] - point;
    if (glm::dot(direction, towards) > kSameDirection * glm::length(towards)) return true;
  }
  return false;
}

// An edge on this side that no neighbour hides: a rim, or a fold away from the side.
bool has_ridge(const Triangle& triangle, const Vec3& side) {
  for (unsigned i = 0; i < 3; ++i) {
    if (!triangle.shared[i]) return true;
    const Vec3 towards = triangle.across[i] - triangle.corner[i];
    if (glm::dot(side, towards) < -kSameDirection * glm::length(towards)) return true;
  }
  return false;
}

std::optional<ConvexDistance> distance_of(const PlacedPart& part, const Triangle& triangle) {
  if (part.core_m.size() > 1) return convex_distance(part.core_m, triangle.corner);
  // A point: exact. On the triangle itself no direction is better than the normal.
  const Vec3 nearest = closest_on_triangle(triangle, part.core_m[0]);
  const Vec3 apart = part.core_m[0] - nearest;
  const double distance_m = glm::length(apart);
  const Vec3 direction =
      distance_m > 1e-12 ? apart / distance_m : glm::normalize(triangle.area_normal());
  return ConvexDistance{distance_m, direction, part.core_m[0], nearest};
}

// The triangle's normal on the side of the part's centre.
Vec3 side_normal(const PlacedPart& part, const Triangle& triangle) {
  const Vec3 normal = glm::normalize(triangle.area_normal());
  return glm::dot(normal, part.centre_m - triangle.corner[0]) < 0.0 ? -normal : normal;
}

double lowest_over(const PlacedPart& part, const Vec3& origin, const Vec3& normal) {
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const Vec3& p : part.core_m) lowest_m = std::min(lowest_m, glm::dot(normal, p - origin));
  return lowest_m;
}

}  // namespace

void add_touch_points(const PlacedPart& part, const Triangle& triangle, double margin_m,
                      std::vector<TouchPoint>& out) {
  const auto [plane_gap_m, side] = plane_separation(part, triangle);
  // Apart, and what is lowest over the plane lies over the triangle: no other feature is nearer.
  const std::size_t before = out.size();
  if (plane_gap_m > -part.radius_m) {
    constexpr double kSameHeight_m = 1e-9;
    if (add_face(part, triangle, side, margin_m, out) <= plane_gap_m + kSameHeight_m) return;
    if (!has_ridge(triangle, side)) return;
    out.resize(before);
  }
  const auto found = distance_of(part, triangle);
  if (!found || found->distance_m - part.radius_m > margin_m) return;
  const double gap_m = found->distance_m - part.radius_m;
  const double facing = glm::dot(found->direction, side);
  if (std::abs(facing) > 1.0 - kSameDirection) {
    const Vec3 normal = facing > 0.0 ? side : -side;
    add_face(part, triangle, normal, margin_m, out);
    if (out.size() == before) out.push_back({found->point_b, normal, gap_m, triangle.index});
    return;
  }
  const unsigned feature = feature_of(triangle, found->point_b);
  if (hidden(triangle, feature, found->point_b, found->direction)) {
    // Through a seam: off this triangle is not out. Back to the centre's side.
    if (found->distance_m < 0.0) add_face(part, triangle, side, margin_m, out);
    return;
  }
  for (unsigned i = 0; i < 3; ++i) {
    if (feature == 1u << i) {
      out.push_back({triangle.corner[i], found->direction, gap_m, triangle.index});
      return;
    }
    if (feature != (1u << i | 1u << (i + 1) % 3)) continue;
    if (!triangle.owned[i]) return;
    if (add_edge(part, triangle.corner[i], triangle.corner[(i + 1) % 3], found->direction, gap_m,
                 triangle.index, out))
      return;
  }
  out.push_back({found->point_b, found->direction, gap_m, triangle.index});
}

Separation plane_separation(const PlacedPart& part, const Triangle& triangle) {
  const Vec3 side = side_normal(part, triangle);
  return {lowest_over(part, triangle.corner[0], side) - part.radius_m, side};
}

Separation box_separation(const PlacedPart& part, const Triangle& triangle) {
  Vec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const Vec3& corner : triangle.corner) {
    const Vec3 along = (corner - part.centre_m) * part.axes;
    low = glm::min(low, along);
    high = glm::max(high, along);
  }
  Separation widest{-std::numeric_limits<double>::infinity(), Vec3(0.0)};
  for (int axis = 0; axis < 3; ++axis) {
    const double above_m = low[axis] - part.high_m[axis], below_m = part.low_m[axis] - high[axis];
    if (above_m > widest.gap_m) widest = {above_m, -part.axes[axis]};
    if (below_m > widest.gap_m) widest = {below_m, part.axes[axis]};
  }
  return widest;
}

Separation widest_separation(const PlacedPart& part, const Triangle& triangle) {
  const auto found = distance_of(part, triangle);
  if (!found) return plane_separation(part, triangle);
  return {found->distance_m - part.radius_m, found->direction};
}

}  // namespace neritic::sim
