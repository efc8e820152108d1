// Things that do not move and block the way: the seabed, meshes, convex parts. Built once from
// plain vertices, indices and heights, then immutable: any number of threads may ask. World frame:
// Y up, metres, any distance from the origin; every query works in coordinates near the body.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "engine/sim/body_shape.hpp"

namespace neritic::sim {

// Surface properties for contacts; in a pair those of the static side count.
struct Surface {
  double friction = 0.5;     // Coulomb's coefficient
  double restitution = 0.0;  // 0 to 1
  std::uint32_t label = 0;   // the caller's, e.g. an instance
};

// Where a thing stands: world_from_thing * (scale * point).
struct Placement {
  Pose world_from_thing;
  double scale = 1.0;  // over 0
};

struct Contact {
  Vec3 point_m{0.0};   // world, on the static side
  Vec3 normal{0.0};    // unit, world, from the static side to the body
  double gap_m = 0.0;  // negative: so deep
  Surface surface;
  std::uint32_t thing = 0, triangle = 0, part = 0;
  // The part's centre is inside, and this leads out; triangle means nothing.
  bool inside = false;
};

struct RayHit {
  double distance_m = 0.0;
  Vec3 normal{0.0};  // unit, world, towards the ray's side
  std::uint32_t label = 0, thing = 0, triangle = 0;
};

struct StaticWorldCounts {
  std::size_t things = 0, triangles = 0;  // placed copies counted each
  std::size_t dropped = 0;                // triangles without area, or on the same three points
  std::size_t creased = 0;                // things whose faces may meet at inner edges: neither
                                          // flat nor convex, or of too many triangles to say
};

struct ContactMemory;  // contact_memory.hpp

class StaticWorld {
 public:
  StaticWorld();
  ~StaticWorld();
  StaticWorld(StaticWorld&&) noexcept;
  StaticWorld& operator=(StaticWorld&&) noexcept;

  // Contacts of a body at a pose with all that is no farther than margin_m, sorted by thing, part
  // and triangle; memory.contacts until its next use. A part whose centre lies in something closed,
  // or below the seabed, gets one contact there that leads out.
  std::span<const Contact> contacts(const BodyShape& shape, const Pose& world_from_body,
                                    double margin_m, ContactMemory& memory) const;

  // The share of the way, 0 to 1, that a body can go from one pose to another, straight and turning
  // at a constant rate, before any part comes deeper than allowed_m into a
  // triangle, or a quarter of that deeper than it starts. 1: all. Things in passable are not looked
  // at. Works in memory.near.
  double sweep(const BodyShape& shape, const Pose& from, const Pose& to, double allowed_m,
               std::span<const std::uint32_t> passable, ContactMemory& memory) const;

  // The nearest surface along the unit direction, up to max_distance_m.
  std::optional<RayHit> cast(const Vec3& origin_m, const Vec3& direction,
                             double max_distance_m) const;

  const StaticWorldCounts& counts() const;

 private:
  friend class StaticWorldBuilder;
  struct Things;
  std::unique_ptr<Things> things_;
};

class StaticWorldBuilder {
 public:
  StaticWorldBuilder();
  ~StaticWorldBuilder();

  // A shape to be placed once or more. Errors name what is wrong; name stands in messages. A mesh
  // without triangles collides with nothing.
  using ShapeId = std::uint32_t;
  Result<ShapeId> add_mesh(std::span<const Vec3f> vertices_m,
                           std::span<const std::uint32_t> indices, const std::string& name);
  // The hull of the points: an error where they lie in a plane.
  Result<ShapeId> add_hull(std::span<const Vec3> points_m, const std::string& name);
  // heights_m [rows][columns], row 0 at -z, NaN for none, centred on its frame's origin in x and z.
  Result<ShapeId> add_heights(std::uint32_t columns, std::uint32_t rows, double cell_m,
                              std::span<const float> heights_m, const std::string& name);
  void place(ShapeId shape, const Placement& placement, const Surface& surface);

  // Everything placed; the builder is empty then.
  StaticWorld build();

 private:
  std::unique_ptr<StaticWorld::Things> things_;
};

}  // namespace neritic::sim
