// Queries of a mesh; how it is built is mesh_topology.cpp's.
#include "engine/sim/triangle_mesh.hpp"

#include <cmath>

namespace neritic::sim {

Triangle TriangleMesh::triangle(std::uint32_t index, double scale, const Vec3& offset) const {
  Triangle out;
  out.index = index;
  for (std::size_t i = 0; i < 3; ++i)
    out.corner[i] = Vec3(vertices_[corners_[index].vertex[i]]) * scale + offset;
  return out;
}

void TriangleMesh::link(Triangle& triangle, double scale, const Vec3& offset) const {
  const Corners& corners = corners_[triangle.index];
  triangle.owned = corners.owned;
  for (std::size_t i = 0; i < 3; ++i) {
    triangle.shared[i] = corners.across[i] != kNone;
    if (triangle.shared[i])
      triangle.across[i] = Vec3(vertices_[corners.across[i]]) * scale + offset;
  }
}

std::optional<TriangleMesh::Hit> TriangleMesh::cast(const Vec3& origin, const Vec3& direction,
                                                    double max_distance) const {
  std::optional<Hit> nearest;
  tree_.along(origin, origin + direction * max_distance, [&](std::uint32_t index) {
    const double limit = nearest ? nearest->distance : max_distance;
    const auto distance = ray_distance(triangle(index, 1.0, -origin), Vec3(0.0), direction, limit);
    // Among triangles at the same distance the lowest index wins, whatever the tree's order.
    if (distance && (!nearest || *distance < limit || index < nearest->triangle))
      nearest = Hit{index, *distance};
  });
  return nearest;
}

// Sum over the closed surfaces that the ray leaves (+1) and enters (-1): their winding number about
// the point, unless it grazes an edge.
int TriangleMesh::winding_along(const Vec3& point, const Vec3& direction) const {
  const double reach = glm::length(solid_bounds_.high - solid_bounds_.low) * 1.01 + 1e-9;
  int winding = 0;
  tree_.along(point, point + direction * reach, [&](std::uint32_t index) {
    if (!corners_[index].solid) return;
    const Triangle seen = triangle(index, 1.0, -point);
    if (ray_distance(seen, Vec3(0.0), direction, reach))
      winding += glm::dot(seen.area_normal(), direction) > 0.0 ? 1 : -1;
  });
  return winding;
}

bool TriangleMesh::inside(const Vec3& point) const {
  if (!solid_bounds_.contains(point)) return false;
  // In general directions; where a ray grazes an edge and the first two disagree, a third decides.
  const bool first = winding_along(point, glm::normalize(Vec3(0.3419, 0.8713, 0.3517))) != 0;
  const bool second = winding_along(point, glm::normalize(Vec3(-0.5407, 0.4139, -0.7321))) != 0;
  if (first == second) return first;
  return winding_along(point, glm::normalize(Vec3(0.1733, -0.9371, 0.3023))) != 0;
}

Vec3 TriangleMesh::nearest_surface(const Vec3& point) const {
  const double widest =
      2.0 * glm::length(solid_bounds_.half()) + glm::length(point - solid_bounds_.centre());
  Vec3 nearest(0.0);
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t of = kNone;
  // A box that doubles until what it finds is nearer than its edge.
  for (double reach = widest / 64.0;; reach *= 2.0) {
    tree_.overlapping(Box{point - Vec3(reach), point + Vec3(reach)}, [&](std::uint32_t index) {
      if (!corners_[index].solid) return;
      const Vec3 candidate = closest_on_triangle(triangle(index, 1.0, Vec3(0.0)), point);
      const double away = glm::length(candidate - point);
      if (away > distance || (away == distance && index > of)) return;
      nearest = candidate;
      distance = away;
      of = index;
    });
    if (distance <= reach || reach > 2.0 * widest) return nearest;
  }
}

}  // namespace neritic::sim
