// Closest points and rays of a triangle.
#include "engine/sim/triangle.hpp"

#include <utility>

namespace neritic::sim {

Vec3 closest_on_triangle(const Triangle& triangle, const Vec3& p) {
  const auto& [a, b, c] = triangle.corner;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const Vec3 bp = p - b;
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + ab * (d1 / (d1 - d3));
  const Vec3 cp = p - c;
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
    return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double sum = va + vb + vc;
  return a + ab * (vb / sum) + ac * (vc / sum);
}

std::optional<double> ray_distance(const Triangle& triangle, const Vec3& origin,
                                   const Vec3& direction, double max_distance) {
  // The ray's largest component becomes z; x and y are sheared so that it runs along z. Then edge
  // functions of the origin in 2D decide, the same numbers for both triangles of an edge.
  const Vec3 size = glm::abs(direction);
  const int z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  int x = (z + 1) % 3, y = (z + 2) % 3;
  if (direction[z] < 0.0) std::swap(x, y);
  const double shear_x = direction[x] / direction[z], shear_y = direction[y] / direction[z];
  std::array<Vec2, 3> flat;
  std::array<Vec3, 3> relative;
  for (std::size_t i = 0; i < 3; ++i) {
    relative[i] = triangle.corner[i] - origin;
    flat[i] =
        Vec2(relative[i][x] - shear_x * relative[i][z], relative[i][y] - shear_y * relative[i][z]);
  }
  const auto edge = [&](std::size_t i, std::size_t j) {
    return flat[i].x * flat[j].y - flat[i].y * flat[j].x;
  };
  const double u = edge(2, 1), v = edge(0, 2), w = edge(1, 0);
  if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return std::nullopt;
  const double sum = u + v + w;
  if (sum == 0.0) return std::nullopt;
  const double along =
      (u * relative[0][z] + v * relative[1][z] + w * relative[2][z]) / (sum * direction[z]);
  if (!(along >= 0.0 && along <= max_distance)) return std::nullopt;
  return along;
}

}  // namespace neritic::sim
