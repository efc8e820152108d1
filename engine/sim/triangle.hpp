// A triangle of the static world as queries see it, and its closest points and rays. Any frame;
// pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "engine/sim/box.hpp"

namespace neritic::sim {

struct Triangle {
  std::array<Vec3, 3> corner;
  std::uint32_t index = 0;
  // Left unset until linked: the third corner of the triangle across the edge from corner i to
  // corner i + 1, where exactly one lies there; contacts on a shared edge are the lower-numbered
  // triangle's.
  std::array<Vec3, 3> across;
  std::array<bool, 3> shared{false, false, false};
  std::array<bool, 3> owned{true, true, true};

  Vec3 area_normal() const { return glm::cross(corner[1] - corner[0], corner[2] - corner[0]); }
  Box box() const {
    Box box;
    for (const Vec3& p : corner) box.add(p);
    return box;
  }
};

// The triangle's point closest to p (Ericson 2005, 5.1.5).
Vec3 closest_on_triangle(const Triangle& triangle, const Vec3& p);

// Distance along the unit direction to the triangle, 0 to max; nothing where it is missed. Either
// side. A ray through an edge that two triangles share meets at least one (Woop, Benthin, Wald
// 2013).
std::optional<double> ray_distance(const Triangle& triangle, const Vec3& origin,
                                   const Vec3& direction, double max_distance);

}  // namespace neritic::sim
