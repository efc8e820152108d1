// Contacts and rays of a static world.
#include "engine/sim/static_world.hpp"

#include <algorithm>
#include <array>
#include <tuple>

#include "engine/sim/contact_memory.hpp"
#include "engine/sim/static_things.hpp"

namespace neritic::sim {
namespace {

constexpr std::uint32_t kNoTriangle = ~0u;

Box box_of(const PlacedPart& part) {
  Box box;
  for (const Vec3& p : part.core_m) box.add(p);
  return box.grown(part.radius_m);
}

// Where the surface is that a part's centre lies behind, in the local frame; nothing where it is
// free.
std::optional<Vec3> way_out(const LocalThing& thing, const Vec3& centre) {
  const Vec3 point = thing.to_shape(centre);
  if (const auto* mesh = std::get_if<TriangleMesh>(&thing.shape)) {
    if (!mesh->has_inside() || !mesh->inside(point)) return std::nullopt;
    return centre + (mesh->nearest_surface(point) - point) * thing.scale;
  }
  const auto height = std::get<HeightGrid>(thing.shape).height(point.x, point.z);
  if (!height || point.y >= *height) return std::nullopt;
  return centre + Vec3(0.0, (*height - point.y) * thing.scale, 0.0);
}

// One contact that leads from the centre to the surface and on until all of the part is out.
TouchPoint escape(const PlacedPart& part, const Vec3& surface) {
  const Vec3 way = surface - part.centre_m;
  const double length_m = glm::length(way);
  const Vec3 normal = length_m > 1e-12 ? way / length_m : Vec3(0.0, 1.0, 0.0);
  double lowest_m = 0.0;
  for (const Vec3& p : part.core_m)
    lowest_m = std::min(lowest_m, glm::dot(normal, p - part.centre_m));
  return {part.centre_m, normal, lowest_m - part.radius_m - length_m, kNoTriangle};
}

void touch(const PlacedPart& part, const LocalThing& thing, double margin_m,
           std::vector<TouchPoint>& out, ThinMemory& thin) {
  const std::size_t first = out.size();
  if (const auto surface = way_out(thing, part.centre_m)) {
    out.push_back(escape(part, *surface));
    return;
  }
  thing.triangles(box_of(part).grown(margin_m), [&](Triangle triangle) {
    if (box_separation(part, triangle).gap_m > margin_m ||
        plane_separation(part, triangle).gap_m > margin_m)
      return;
    thing.link(triangle);
    add_touch_points(part, triangle, margin_m, out);
  });
  // The tree's order is Bullet's; ours is by number.
  const auto key = [](const TouchPoint& p) {
    return std::tuple(p.triangle, p.point_m.x, p.point_m.y, p.point_m.z);
  };
  std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
            [&](const TouchPoint& a, const TouchPoint& b) { return key(a) < key(b); });
  thin_touch_points(out, first, thin);
}

}  // namespace

std::span<const Contact> StaticWorld::contacts(const BodyShape& shape, const Pose& world_from_body,
                                               double margin_m, ContactMemory& memory) const {
  auto& near = memory.near;
  auto& points = memory.points;
  auto& out = memory.contacts;
  near.clear();
  out.clear();
  const Vec3& origin_m = world_from_body.position_m;
  const double reach_m = shape.reach_m() + margin_m;
  const Box around{origin_m - Vec3(reach_m), origin_m + Vec3(reach_m)};
  things_->tree.overlapping(around, [&](std::uint32_t i) {
    if (things_->things[i].bounds.overlaps(around)) near.push_back(i);
  });
  std::sort(near.begin(), near.end());
  PartPoints storage;
  for (const std::uint32_t i : near) {
    const StaticThing& thing = things_->things[i];
    const LocalThing local(things_->shapes[thing.shape], thing.placement, origin_m);
    const Mat3 local_from_body = local.thing_from_world * glm::mat3_cast(world_from_body.rotation);
    const Mat3 world_from_local = glm::transpose(local.thing_from_world);
    for (std::size_t p = 0; p < shape.parts().size(); ++p) {
      points.clear();
      touch(place_part(shape.parts()[p], local_from_body, Vec3(0.0), storage), local, margin_m,
            points, memory.thin);
      for (const TouchPoint& point : points)
        out.push_back({origin_m + world_from_local * point.point_m, world_from_local * point.normal,
                       point.gap_m, thing.surface, i, point.triangle, static_cast<std::uint32_t>(p),
                       point.triangle == kNoTriangle});
    }
  }
  return out;
}

std::optional<RayHit> StaticWorld::cast(const Vec3& origin_m, const Vec3& direction,
                                        double max_distance_m) const {
  std::optional<RayHit> nearest;
  things_->tree.along(origin_m, origin_m + direction * max_distance_m, [&](std::uint32_t i) {
    const StaticThing& thing = things_->things[i];
    const LocalThing local(things_->shapes[thing.shape], thing.placement, origin_m);
    const Vec3 along = local.thing_from_world * direction;
    const double limit_m = nearest ? nearest->distance_m : max_distance_m;
    const auto take = [&](const auto& shape) {
      const auto hit =
          shape.cast(local.to_shape(Vec3(0.0)), along, limit_m / thing.placement.scale);
      if (!hit) return;
      const double distance_m = hit->distance * thing.placement.scale;
      if (nearest && (distance_m > limit_m || (distance_m == limit_m && i > nearest->thing)))
        return;
      nearest = RayHit{distance_m, Vec3(0.0), thing.surface.label, i, hit->triangle};
    };
    std::visit(take, local.shape);
  });
  if (!nearest) return nearest;
  const StaticThing& thing = things_->things[nearest->thing];
  const auto& shape = things_->shapes[thing.shape];
  const Triangle triangle =
      std::holds_alternative<TriangleMesh>(shape)
          ? std::get<TriangleMesh>(shape).triangle(nearest->triangle, 1.0, Vec3(0.0))
          : *std::get<HeightGrid>(shape).triangle(nearest->triangle, 1.0, Vec3(0.0));
  nearest->normal =
      thing.placement.world_from_thing.rotation * glm::normalize(triangle.area_normal());
  if (glm::dot(nearest->normal, direction) > 0.0) nearest->normal = -nearest->normal;
  return nearest;
}

}  // namespace neritic::sim
