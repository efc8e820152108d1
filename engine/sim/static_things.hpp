// The contents of a static world, for the sources that query it.
#pragma once

#include <array>
#include <variant>
#include <vector>

#include "engine/sim/box_tree.hpp"
#include "engine/sim/height_grid.hpp"
#include "engine/sim/manifold.hpp"
#include "engine/sim/static_world.hpp"
#include "engine/sim/triangle_mesh.hpp"

namespace neritic::sim {

using StaticShape = std::variant<TriangleMesh, HeightGrid>;

struct StaticThing {
  std::uint32_t shape = 0;
  Placement placement;
  Surface surface;
  Box bounds;  // world
};

struct StaticWorld::Things {
  std::vector<StaticShape> shapes;
  std::vector<bool> creased;  // of each shape
  std::vector<StaticThing> things;
  BoxTree tree;  // over the things
  StaticWorldCounts counts;
};

// A thing as a query sees it: its own axes, in metres, about a point near the body.
struct LocalThing {
  const StaticShape& shape;
  double scale;
  Vec3 origin_m;          // of the local frame, in the thing's axes, scaled
  Mat3 thing_from_world;  // directions

  LocalThing(const StaticShape& shape_, const Placement& placement, const Vec3& world_origin_m)
      : shape(shape_),
        scale(placement.scale),
        origin_m(glm::conjugate(placement.world_from_thing.rotation) *
                 (world_origin_m - placement.world_from_thing.position_m)),
        thing_from_world(glm::mat3_cast(glm::conjugate(placement.world_from_thing.rotation))) {}

  // From the local frame to the shape's.
  Vec3 to_shape(const Vec3& local_m) const { return (origin_m + local_m) / scale; }
  Box to_shape(const Box& local) const { return {to_shape(local.low), to_shape(local.high)}; }

  void link(Triangle& triangle) const {
    std::visit([&](const auto& s) { s.link(triangle, scale, -origin_m); }, shape);
  }
  // Calls found(triangle) with those near the box, in the local frame, not linked.
  template <class Found>
  void triangles(const Box& local, Found&& found) const {
    const Box box = to_shape(local);
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape))
      mesh->overlapping(box, [&](std::uint32_t i) { found(mesh->triangle(i, scale, -origin_m)); });
    else
      std::get<HeightGrid>(shape).overlapping(box, [&](std::uint32_t i) {
        if (const auto triangle = std::get<HeightGrid>(shape).triangle(i, scale, -origin_m))
          found(*triangle);
      });
  }
};

// A part turned and moved; the points' memory is the caller's.
using PartPoints = std::array<Vec3, kMaxCorePoints>;
inline PlacedPart place_part(const ConvexPart& part, const Mat3& turn, const Vec3& move_m,
                             PartPoints& storage) {
  for (std::size_t i = 0; i < part.core_m.size(); ++i) storage[i] = turn * part.core_m[i] + move_m;
  return {std::span(storage.data(), part.core_m.size()),
          turn * part.centre_m + move_m,
          part.radius_m,
          part.reach_m,
          turn * part.axes,
          part.low_m,
          part.high_m};
}

}  // namespace neritic::sim
