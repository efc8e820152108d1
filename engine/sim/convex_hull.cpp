// Convex hulls by Bullet.
#include "engine/sim/convex_hull.hpp"

#include <algorithm>
#include <limits>

#include "engine/sim/bullet.hpp"

namespace neritic::sim {
namespace {

ConvexHull hull_of(const btConvexHullComputer& computer) {
  ConvexHull hull;
  for (int i = 0; i < computer.vertices.size(); ++i)
    hull.corners.push_back(from_bullet(computer.vertices[i]));
  for (int i = 0; i < computer.faces.size(); ++i) {
    const btConvexHullComputer::Edge* const start = &computer.edges[computer.faces[i]];
    const auto first = static_cast<std::uint32_t>(start->getSourceVertex());
    // A fan over the face's edges.
    for (const auto* edge = start->getNextEdgeOfFace(); edge->getTargetVertex() != int(first);
         edge = edge->getNextEdgeOfFace())
      hull.triangles.push_back({first, static_cast<std::uint32_t>(edge->getSourceVertex()),
                                static_cast<std::uint32_t>(edge->getTargetVertex())});
  }
  return hull;
}

Vec3 mean_of(const std::vector<Vec3>& points) {
  Vec3 sum(0.0);
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

// Turns triangles outwards and finds the nearest face to the mean.
void settle(ConvexHull& hull) {
  if (hull.corners.size() < 4) {
    hull.triangles.clear();
    return;
  }
  const Vec3 mean = mean_of(hull.corners);
  double extent = 0.0;
  for (const Vec3& p : hull.corners) extent = std::max(extent, glm::length(p - mean));
  double nearest = std::numeric_limits<double>::infinity();
  for (auto& [a, b, c] : hull.triangles) {
    const Vec3 area =
        glm::cross(hull.corners[b] - hull.corners[a], hull.corners[c] - hull.corners[a]);
    const double twice = glm::length(area);
    if (twice <= 1e-12 * extent * extent) continue;
    const double distance = glm::dot(hull.corners[a] - mean, area) / twice;
    if (distance < 0.0) std::swap(b, c);
    nearest = std::min(nearest, std::abs(distance));
  }
  if (!(nearest > 1e-9 * extent) || nearest > extent) {
    hull.triangles.clear();
    return;
  }
  hull.inner_radius = nearest;
}

}  // namespace

HullResult convex_hull(std::span<const Vec3> points, const HullOptions& options) {
  HullResult result;
  if (points.size() < 4) return result;
  btConvexHullComputer computer;
  computer.compute(&points[0].x, static_cast<int>(sizeof(Vec3)), static_cast<int>(points.size()),
                   0.0, 0.0);
  result.hull = hull_of(computer);
  settle(result.hull);
  if (result.hull.triangles.empty() || options.shrink <= 0.0) return result;
  const double shrink = std::min(options.shrink, 0.2 * result.hull.inner_radius);
  // Faces of the hull moved inwards; Bullet's own measure of the inside bounds it once more.
  btConvexHullComputer inner;
  const double shrunk = inner.compute(&points[0].x, static_cast<int>(sizeof(Vec3)),
                                      static_cast<int>(points.size()), shrink, 0.2);
  ConvexHull smaller = hull_of(inner);
  settle(smaller);
  if (shrunk <= 0.0 || smaller.triangles.empty()) return result;
  return {std::move(smaller), shrunk};
}

}  // namespace neritic::sim
