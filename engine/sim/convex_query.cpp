// GJK for sets apart, EPA for sets that overlap.
#include "engine/sim/convex_query.hpp"

#include <array>

#include "engine/core/check.hpp"
#include "engine/sim/body_shape.hpp"
#include "engine/sim/bullet.hpp"

namespace neritic::sim {
namespace {

using PointArray = std::array<btVector3, kMaxCorePoints>;

btConvexPointCloudShape shape_of(std::span<const Vec3> points, PointArray& storage) {
  NERITIC_CHECK(!points.empty() && points.size() <= storage.size(), "{} points", points.size());
  for (std::size_t i = 0; i < points.size(); ++i) storage[i] = to_bullet(points[i]);
  btConvexPointCloudShape shape;
  shape.setPoints(storage.data(), static_cast<int>(points.size()), false);
  shape.setMargin(0.0);
  return shape;
}

}  // namespace

std::optional<ConvexDistance> convex_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  PointArray points_a, points_b;
  const btConvexPointCloudShape shape_a = shape_of(a, points_a), shape_b = shape_of(b, points_b);
  btVoronoiSimplexSolver simplex;
  btGjkPairDetector detector(&shape_a, &shape_b, &simplex, nullptr);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA.setIdentity();
  input.m_transformB.setIdentity();
  btPointCollector found;
  detector.getClosestPoints(input, found, nullptr);
  if (found.m_hasResult && found.m_distance > 0.0) {
    const Vec3 direction = from_bullet(found.m_normalOnBInWorld);
    const Vec3 point_b = from_bullet(found.m_pointInWorld);
    return ConvexDistance{found.m_distance, direction, point_b + direction * found.m_distance,
                          point_b};
  }
  btGjkEpaSolver2::sResults deep;
  const btTransform identity = btTransform::getIdentity();
  const btVector3 guess = to_bullet(b[0] - a[0]);
  if (!btGjkEpaSolver2::Penetration(&shape_a, identity, &shape_b, identity, guess, deep, false))
    return std::nullopt;
  const Vec3 normal = from_bullet(deep.normal);
  if (!(glm::dot(normal, normal) > 0.5)) return std::nullopt;
  return ConvexDistance{deep.distance, normal, from_bullet(deep.witnesses[0]),
                        from_bullet(deep.witnesses[1])};
}

}  // namespace neritic::sim
