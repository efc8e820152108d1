// Convex parts of a moving body.
#include "engine/sim/body_shape.hpp"

#include <algorithm>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"
#include "engine/sim/convex_hull.hpp"
#include "engine/sim/plane_axes.hpp"

namespace neritic::sim {
namespace {

bool is_length(double value_m) {
  return std::isfinite(value_m) && value_m > 0.0;
}

}  // namespace

void BodyShape::add(ConvexPart part, double half_thickness_m, const Mat3& axes) {
  NERITIC_CHECK(!part.core_m.empty() && part.core_m.size() <= kMaxCorePoints, "{} points",
                part.core_m.size());
  Vec3 sum(0.0);
  for (const Vec3& p : part.core_m) {
    NERITIC_CHECK(is_finite(p), "({}, {}, {})", p.x, p.y, p.z);
    sum += p;
  }
  part.centre_m = sum / static_cast<double>(part.core_m.size());
  part.axes = axes;
  for (const Vec3& p : part.core_m) {
    const Vec3 from_centre = p - part.centre_m;
    part.reach_m = std::max(part.reach_m, glm::length(from_centre) + part.radius_m);
    const Vec3 along = from_centre * part.axes;  // its components along the axes
    part.low_m = glm::min(part.low_m, along - Vec3(part.radius_m));
    part.high_m = glm::max(part.high_m, along + Vec3(part.radius_m));
    reach_m_ = std::max(reach_m_, glm::length(p) + part.radius_m);
  }
  thinnest_m_ = parts_.empty() ? half_thickness_m : std::min(thinnest_m_, half_thickness_m);
  parts_.push_back(std::move(part));
}

void BodyShape::add_sphere(const Vec3& centre_m, double radius_m) {
  NERITIC_CHECK(is_length(radius_m), "radius {} m", radius_m);
  add({{centre_m}, radius_m}, radius_m);
}

void BodyShape::add_capsule(const Vec3& from_m, const Vec3& to_m, double radius_m) {
  NERITIC_CHECK(is_length(radius_m), "radius {} m", radius_m);
  if (from_m == to_m) return add_sphere(from_m, radius_m);
  const Vec3 along = glm::normalize(to_m - from_m);
  const PlaneAxes across = plane_axes(along);
  add({{from_m, to_m}, radius_m}, radius_m, Mat3(across.x, across.y, along));
}

void BodyShape::add_box(const Pose& body_from_box, const Vec3& half_m) {
  NERITIC_CHECK(is_length(half_m.x) && is_length(half_m.y) && is_length(half_m.z),
                "half sizes {} {} {} m", half_m.x, half_m.y, half_m.z);
  const double thinnest_m = std::min({half_m.x, half_m.y, half_m.z});
  const double radius_m = std::min(kEdgeRadius_m, 0.2 * thinnest_m);
  ConvexPart part;
  part.radius_m = radius_m;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1) ? 1.0 : -1.0, (corner & 2) ? 1.0 : -1.0,
                    (corner & 4) ? 1.0 : -1.0);
    part.core_m.push_back(body_from_box * (sign * (half_m - Vec3(radius_m))));
  }
  add(std::move(part), thinnest_m, glm::mat3_cast(body_from_box.rotation));
}

Status BodyShape::add_hull(std::span<const Vec3> points_m, const std::string& name) {
  for (std::size_t i = 0; i < points_m.size(); ++i)
    if (!is_finite(points_m[i]))
      return refusal(name, fmt::format("point {}, which is not finite", i), "finite numbers");
  const auto [hull, shrunk_m] = convex_hull(points_m, {.shrink = kEdgeRadius_m});
  if (hull.triangles.empty())
    return refusal(name, fmt::format("a hull of {} points without volume", points_m.size()),
                   "four points or more, not in a plane");
  if (hull.corners.size() > kMaxCorePoints)
    return refusal(name, fmt::format("a hull with {} corners", hull.corners.size()),
                   fmt::format("up to {}", kMaxCorePoints));
  add({hull.corners, shrunk_m}, hull.inner_radius + shrunk_m);
  return {};
}

}  // namespace neritic::sim
