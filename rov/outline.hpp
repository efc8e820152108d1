// A vehicle's outline: the convex parts that touch things. Body axes forward, starboard, down,
// about the body's origin; metres. Plain values; any thread.
#pragma once

#include <variant>
#include <vector>

#include "engine/core/case_file.hpp"
#include "engine/core/math.hpp"

namespace neritic::rov {

struct OutlineBox {
  Vec3 position_m{0.0};
  Quat rotation{1.0, 0.0, 0.0, 0.0};  // body_from_box
  Vec3 size_m{1.0};
};
struct OutlineSphere {
  Vec3 position_m{0.0};
  double radius_m = 1.0;
};
struct OutlineCapsule {
  Vec3 from_m{0.0}, to_m{0.0};
  double radius_m = 1.0;
};
// The convex hull of these points.
struct OutlineHull {
  std::vector<Vec3> points_m;
};
using OutlinePart = std::variant<OutlineBox, OutlineSphere, OutlineCapsule, OutlineHull>;

// So many parts of one vehicle.
inline constexpr std::size_t kMaxOutlineParts = 32;

// [[outline]] of a vehicle's file.
std::vector<OutlinePart> read_outline(const CaseField& list);

}  // namespace neritic::rov
