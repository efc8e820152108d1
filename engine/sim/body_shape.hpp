// A moving body's shape for collisions: convex parts in body axes (any right-handed axes of the
// caller's, about any origin). A part is the hull of its core points, rounded by a radius: a sphere
// is one point, a capsule two. Boxes and hulls keep their size: their cores lie a little inside,
// and that much of their edges is round. Built once, then only read; any thread.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::sim {

// Most core points of a part.
inline constexpr std::size_t kMaxCorePoints = 64;
// Rounding of boxes and hulls: at most this, and a fifth of their half thickness.
inline constexpr double kEdgeRadius_m = 0.005;

struct ConvexPart {
  std::vector<Vec3> core_m;
  double radius_m = 0.0;
  Vec3 centre_m{0.0};    // inside the core
  double reach_m = 0.0;  // farthest point of the rounded part from the centre
  // The box about the rounded part, about the centre along its own axes.
  Mat3 axes{1.0};
  Vec3 low_m{0.0}, high_m{0.0};
};

class BodyShape {
 public:
  // Lengths are positive and finite, points finite: else NERITIC_CHECK.
  void add_sphere(const Vec3& centre_m, double radius_m);
  void add_capsule(const Vec3& from_m, const Vec3& to_m, double radius_m);
  void add_box(const Pose& body_from_box, const Vec3& half_m);
  // The hull of points from a file: an error where they are not finite, lie in a plane, or their
  // hull has more than kMaxCorePoints corners. name stands in messages.
  Status add_hull(std::span<const Vec3> points_m, const std::string& name);

  const std::vector<ConvexPart>& parts() const { return parts_; }
  // Farthest point from the body's origin.
  double reach_m() const { return reach_m_; }
  // The smallest half thickness of any part: no motion much shorter can pass a surface unseen.
  double thinnest_m() const { return thinnest_m_; }

 private:
  void add(ConvexPart part, double half_thickness_m, const Mat3& axes = Mat3(1.0));

  std::vector<ConvexPart> parts_;
  double reach_m_ = 0.0;
  double thinnest_m_ = 0.0;
};

}  // namespace neritic::sim
