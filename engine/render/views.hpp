// Views are drawn in sets: one camera, a stereo pair by multiview, a sonar's sectors. All share an
// origin (a point in the world, double), and everything on the GPU is relative to it in floats.
// Plain data; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/math.hpp"
#include "shared/raster.h"

namespace neritic::render {

struct ViewDesc {
  Pose world_from_view;
  FrustumTangents tangents;
  double near_m = 0.05;
  // The sides lean: a point at (x, y) of unit distance lies between them where left <= x - lean y
  // <= right, so that each row of pixels is shifted against the one above by the same part of a
  // pixel. Only sonars use it.
  double lean = 0.0;
  Pose next_world_from_view;  // at the next frame's time, for motion
  // Triangles that nobody sees, three corners each, as tangents (x right, y up at z = -1): a
  // headset's lens has no room for them. They are not shaded. At most kMostHidden corners.
  std::vector<Vec2f> hidden;
};
inline constexpr std::size_t kMostHidden = 6000;

// Points of the world with dot(normal, point) + offset_m >= 0. normal: unit.
struct HalfSpace {
  Vec3 normal{0.0, 1.0, 0.0};
  double offset_m = 0.0;
};

struct ViewSet {
  std::uint32_t width = 1, height = 1;  // pixels, each view's
  std::vector<ViewDesc> views;          // 1 to shared::kMaxViews
  std::optional<HalfSpace> within;      // nothing else is seen: of what a mirror shows
  // The object whose eyes these are, drawn without its head; kWornByNobody: none. Its frame must
  // have been made with that object (evaluate_frame).
  static constexpr std::uint32_t kWornByNobody = ~0u;
  std::uint32_t worn_object = kWornByNobody;
  Vec3 origin_m() const { return views.front().world_from_view.position_m; }
  std::uint32_t layers() const { return static_cast<std::uint32_t>(views.size()); }
};

// The set as a uniform block of kMaxViews for the shaders; entries beyond the set's own views are
// zero.
std::array<shared::View, shared::kMaxViews> gpu_views(const ViewSet& set);

// Bound of a position's error on the GPU, relative to the sizes of the terms that are summed:
// rows rounded to float, four products and sums, then four more to clip space. (1 + 4 + 4) 2^-24 is
// 5.4e-7; this is near four times that.
inline constexpr double kFloatError = 2e-6;

// No length grows by more than this under the matrix: the largest row sum of its Gram matrix bounds
// the square of every stretch, sheared or not, and is exact for turns and even scales.
double largest_stretch(const Mat4& m);

// The same question for many spheres of one set, which this keeps as planes. A sphere that lies
// past a corner may count as seen.
class SphereCulling {
  struct Plane {
    Vec3 normal{0.0};  // unit, inwards
    double offset_m = 0.0;
  };

 public:
  // The planes that cut through a ball: of what lies in the ball no others need be asked.
  class Part {
   public:
    // As SphereCulling::may_see says it, of a sphere within the ball.
    bool may_see(const Vec3& center_from_origin_m, double radius_m) const;

   private:
    friend class SphereCulling;
    std::vector<Plane> planes_;
    std::vector<std::size_t> ends_;  // a view's planes end here; the first are the set's own
  };

  explicit SphereCulling(const ViewSet& set);
  // From where the set's centers count, in the world.
  const Vec3& origin_m() const { return origin_m_; }
  bool may_see(const Vec3& center_from_origin_m, double radius_m) const;
  // The same of a box that may lie askew, within a sphere round its center: from there to the
  // middles of three sides. margin_m: how far beyond the box something may reach.
  bool may_see_box(const Vec3& center_from_origin_m, double radius_m,
                   const std::array<Vec3, 3>& halves_m, double margin_m) const;
  // The same of all that a sphere sweeps on the way from one place to the other.
  bool may_see_between(const Vec3& from_origin_m, const Vec3& to_m, double radius_m) const;
  // Whether the ball may be seen, and if so the part of the planes that cuts it; part is made anew.
  bool may_see(const Vec3& center_from_origin_m, double radius_m, Part& part) const;
  // Narrows low_m and high_m to the x between which the center of a sphere may lie that is seen, on
  // the line along x through a place. False: nowhere.
  bool narrow(const Vec3& from_origin_m, double radius_m, double& low_m, double& high_m) const;

 private:
  Vec3 origin_m_;
  std::vector<std::array<Plane, 5>> views_;
  std::optional<Plane> within_;
};

// True where a sphere (relative to the set's origin) can be in any view.
bool any_view_sees(const ViewSet& set, const Vec3& center_from_origin_m, double radius_m);

}  // namespace neritic::render
