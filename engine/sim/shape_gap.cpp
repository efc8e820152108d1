#include "engine/sim/shape_gap.hpp"

#include "engine/sim/convex_query.hpp"
#include "engine/sim/static_things.hpp"

namespace neritic::sim {

std::optional<ShapeGap> shape_gap(const BodyShape& a, const Pose& world_from_a, const BodyShape& b,
                                  const Pose& world_from_b, double most_m) {
  const Vec3 b_from_a_m = world_from_b.position_m - world_from_a.position_m;
  if (glm::length(b_from_a_m) > a.reach_m() + b.reach_m() + most_m) return std::nullopt;
  const Mat3 turn_a = glm::mat3_cast(world_from_a.rotation),
             turn_b = glm::mat3_cast(world_from_b.rotation);
  PartPoints storage_a, storage_b;
  std::optional<ShapeGap> nearest;
  for (const ConvexPart& part_a : a.parts()) {
    const PlacedPart pa = place_part(part_a, turn_a, Vec3(0.0), storage_a);
    for (const ConvexPart& part_b : b.parts()) {
      const PlacedPart pb = place_part(part_b, turn_b, b_from_a_m, storage_b);
      if (glm::distance(pa.centre_m, pb.centre_m) > pa.reach_m + pb.reach_m + most_m) continue;
      const auto found = convex_distance(pa.core_m, pb.core_m);
      if (!found) continue;
      const double gap_m = found->distance_m - pa.radius_m - pb.radius_m;
      if (gap_m > (nearest ? nearest->gap_m : most_m)) continue;
      const Vec3 on_b = found->point_b + found->direction * pb.radius_m;
      nearest = {gap_m, world_from_a.position_m + on_b + found->direction * (0.5 * gap_m),
                 found->direction};
    }
  }
  return nearest;
}

}  // namespace neritic::sim
