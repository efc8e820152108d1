// Axes across a direction. Pure.
#pragma once

#include <cmath>

#include "engine/core/math.hpp"

namespace neritic::sim {

// Unit axes x and y across a unit normal, right-handed with it; the same for the same normal.
struct PlaneAxes {
  Vec3 x, y;
};
inline PlaneAxes plane_axes(const Vec3& normal) {
  const Vec3 side = std::abs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  const Vec3 x = glm::normalize(glm::cross(side, normal));
  return {x, glm::cross(normal, x)};
}

// Directions nearer than this are one, as 1 - cosine: 1.4 mrad. GJK answers to some 1e-7.
inline constexpr double kSameDirection = 1e-6;

}  // namespace neritic::sim
