// Where a rounded convex part touches, or is about to touch, a triangle. One frame for both, its
// origin near the part (static_world.cpp: the collider's axes about the body's origin). Pure
// functions without allocation but that of the list's own memory; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/sim/triangle.hpp"

namespace neritic::sim {

// A part as one query sees it.
struct PlacedPart {
  std::span<const Vec3> core_m;
  Vec3 centre_m{0.0};
  double radius_m = 0.0;
  double reach_m = 0.0;
  Mat3 axes{1.0};
  Vec3 low_m{0.0}, high_m{0.0};
};

struct TouchPoint {
  Vec3 point_m{0.0};   // on the triangle
  Vec3 normal{0.0};    // unit, from the triangle to the part
  double gap_m = 0.0;  // negative: so deep
  std::uint32_t triangle = 0;
};

// Adds the points of the linked triangle at which the part is no farther than margin_m away. A face
// gives the corners of the common area, an edge the ends of the common length. Contacts of an edge
// or corner that another triangle hides are left out, so that nothing catches on the seams of a
// smooth surface.
void add_touch_points(const PlacedPart& part, const Triangle& triangle, double margin_m,
                      std::vector<TouchPoint>& out);

// A plane between part and triangle: the part lies at least gap_m beyond it along the direction.
// Negative where they overlap.
struct Separation {
  double gap_m = 0.0;
  Vec3 direction{0.0};
};
// The triangle's own plane, on the side of the part's centre: quick, and often enough. Needs no
// links.
Separation plane_separation(const PlacedPart& part, const Triangle& triangle);
// The part's own box's planes: as quick.
Separation box_separation(const PlacedPart& part, const Triangle& triangle);
// The widest.
Separation widest_separation(const PlacedPart& part, const Triangle& triangle);

struct ThinMemory {
  std::vector<char> seen, keep;  // of each point
  std::vector<std::size_t> group;
};
// Among points with the same normal a few suffice: the deepest, and the outermost in eight
// directions. Keeps the order; points[from] on are thinned. memory: any content.
void thin_touch_points(std::vector<TouchPoint>& points, std::size_t from, ThinMemory& memory);

}  // namespace neritic::sim
