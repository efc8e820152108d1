// Boxes along the axes of a frame. Plain values.
#pragma once

#include <limits>

#include "engine/core/math.hpp"

namespace neritic::sim {

struct Box {
  Vec3 low{std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity()};

  void add(const Vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const Box& box) {
    low = glm::min(low, box.low);
    high = glm::max(high, box.high);
  }
  bool empty() const { return !(low.x <= high.x); }
  Box grown(double by) const { return {low - Vec3(by), high + Vec3(by)}; }
  bool contains(const Vec3& p) const {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z &&
           p.z <= high.z;
  }
  bool overlaps(const Box& other) const {
    return low.x <= other.high.x && high.x >= other.low.x && low.y <= other.high.y &&
           high.y >= other.low.y && low.z <= other.high.z && high.z >= other.low.z;
  }
  Vec3 centre() const { return 0.5 * (low + high); }
  Vec3 half() const { return 0.5 * (high - low); }
};

// The box about a box that is scaled, turned and moved.
inline Box transformed(const Pose& a_from_b, double scale, const Box& box_b) {
  const Vec3 centre = a_from_b * (scale * box_b.centre());
  const Mat3 turn = glm::mat3_cast(a_from_b.rotation);
  const Vec3 half = std::abs(scale) * box_b.half();
  const Vec3 reach =
      glm::abs(turn[0]) * half.x + glm::abs(turn[1]) * half.y + glm::abs(turn[2]) * half.z;
  return {centre - reach, centre + reach};
}

}  // namespace neritic::sim
