// How far a body can go. Conservative advancement (Mirtich 1996): while a plane separates a part
// and a triangle, they cannot touch before its gap is used up at the closing speed along its
// normal.
#include <algorithm>
#include <cmath>

#include "engine/sim/contact_memory.hpp"
#include "engine/sim/static_things.hpp"

namespace neritic::sim {
namespace {

// Straight with a turn at a constant rate, over time 0 to 1.
struct Way {
  Pose from;
  Vec3 move_m{0.0};
  Vec3 axis{0.0, 1.0, 0.0};
  double turn_rad = 0.0;

  Way(const Pose& from_, const Pose& to) : from(from_), move_m(to.position_m - from_.position_m) {
    Quat turn = to.rotation * glm::conjugate(from.rotation);
    if (turn.w < 0.0) turn = -turn;
    const Vec3 vector(turn.x, turn.y, turn.z);
    const double sine = glm::length(vector);
    if (sine < 1e-12) return;
    axis = vector / sine;
    turn_rad = 2.0 * std::atan2(sine, turn.w);
  }
  Quat rotation(double time) const {
    return glm::normalize(glm::angleAxis(turn_rad * time, axis) * from.rotation);
  }
};

struct Sweeper {
  const Way& way;
  double spin_m;  // most that any point moves by the turn

  double depth_at_start(const ConvexPart& part, const Triangle& triangle,
                        const LocalThing& thing) const {
    PartPoints storage;
    const Mat3 turn = thing.thing_from_world * glm::mat3_cast(way.from.rotation);
    const PlacedPart placed = place_part(part, turn, Vec3(0.0), storage);
    const double gap_m =
        std::max(box_separation(placed, triangle).gap_m, plane_separation(placed, triangle).gap_m);
    return gap_m > 0.0 ? -gap_m : -widest_separation(placed, triangle).gap_m;
  }

  // First time from `start` on, before `end`, at which the part is as deep as it may be; end where
  // it never is.
  double advance(const ConvexPart& part, const Triangle& triangle, const LocalThing& thing,
                 double may_m, double start, double end) const {
    constexpr double kHit_m = 1e-6;
    constexpr int kMostRounds = 100;
    const Vec3 move_m = thing.thing_from_world * way.move_m;
    PartPoints storage;
    double time = start;
    for (int round = 0; round < kMostRounds; ++round) {
      const Mat3 turn = thing.thing_from_world * glm::mat3_cast(way.rotation(time));
      const PlacedPart placed = place_part(part, turn, move_m * time, storage);
      const auto closing = [&](const Vec3& direction) {
        return std::max(-glm::dot(move_m, direction), 0.0) + spin_m;
      };
      const auto is_free = [&](const Separation& apart) {
        return apart.gap_m + may_m > closing(apart.direction) * (end - time);
      };
      if (is_free(box_separation(placed, triangle)) || is_free(plane_separation(placed, triangle)))
        return end;
      const Separation apart = widest_separation(placed, triangle);
      const double room_m = apart.gap_m + may_m;
      if (room_m <= kHit_m) return time;
      const double speed_m = closing(apart.direction);
      if (room_m >= speed_m * (end - time)) return end;
      time += room_m / speed_m;
    }
    return time;
  }
};

}  // namespace

double StaticWorld::sweep(const BodyShape& shape, const Pose& from, const Pose& to,
                          double allowed_m, std::span<const std::uint32_t> passable,
                          ContactMemory& memory) const {
  const Way way(from, to);
  const double reach_m = shape.reach_m();
  const Sweeper sweeper{way, way.turn_rad * reach_m};
  // In pieces of a few body lengths, so that a long way does not gather everything beside it.
  constexpr double kMostPieces = 4096.0;
  const double length_m = glm::length(way.move_m);
  const double pieces = std::clamp(std::ceil(length_m / (4.0 * reach_m)), 1.0, kMostPieces);
  std::vector<std::uint32_t>& near = memory.near;

  for (double piece = 0.0; piece < pieces; ++piece) {
    const double start = piece / pieces, end = (piece + 1.0) / pieces;
    Box around;
    around.add(from.position_m + way.move_m * start);
    around.add(from.position_m + way.move_m * end);
    around = around.grown(reach_m);
    near.clear();
    things_->tree.overlapping(around, [&](std::uint32_t i) {
      const bool in_the_way = std::find(passable.begin(), passable.end(), i) == passable.end();
      if (in_the_way && things_->things[i].bounds.overlaps(around)) near.push_back(i);
    });
    double first = end;
    bool hit = false;
    for (const std::uint32_t i : near) {
      const StaticThing& thing = things_->things[i];
      const LocalThing local(things_->shapes[thing.shape], thing.placement, from.position_m);
      const Box box = transformed({-(local.thing_from_world * from.position_m),
                                   glm::conjugate(thing.placement.world_from_thing.rotation)},
                                  1.0, around);
      local.triangles(box, [&](const Triangle& triangle) {
        for (const ConvexPart& part : shape.parts()) {
          double time = sweeper.advance(part, triangle, local, allowed_m, start, first);
          if (time >= first) continue;
          const double depth_m = sweeper.depth_at_start(part, triangle, local);
          const double may_m = depth_m + 0.25 * allowed_m;
          if (may_m > allowed_m) time = sweeper.advance(part, triangle, local, may_m, start, first);
          if (time >= first) continue;
          first = time;
          hit = true;
        }
      });
    }
    if (hit) return first;
  }
  return 1.0;
}

}  // namespace neritic::sim
