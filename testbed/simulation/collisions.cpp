#include "testbed/simulation/collisions.hpp"

#include <algorithm>

#include "diver/frames.hpp"
#include "engine/sim/shape_gap.hpp"
#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

// Two bodies that touched in a step may have parted by its end: at 10 m/s by 0.04 m.
constexpr double kApart_m = 0.05;

// A reading in which nothing was found yet.
constexpr double kNothing_m = -kApart_m;

}  // namespace

CollisionFinder::Body CollisionFinder::body(OwnerSort sort, std::uint32_t owner,
                                            const PhysicsState& state) const {
  if (sort == OwnerSort::kVehicle) {
    const rov::State& now = state.vehicles()[owner].body;
    return {world_.vehicles()[owner].kind.solid.shape,
            rov::world_pose(now.position_ned_m, now.attitude)};
  }
  const diver::RootState& now = state.humans()[owner].human.root;
  return {world_.humans()[owner].shape, world_pose(now.position_ned_m, now.attitude)};
}

void CollisionFinder::find_solid(const Body& body, CollisionReading& reading) {
  for (const sim::Contact& contact :
       world_.solid().contacts(body.shape, body.world_from_body, kApart_m, memory_)) {
    if (-contact.gap_m <= reading.depth_m) continue;
    reading.point_m = contact.point_m;
    reading.normal = contact.normal;
    reading.depth_m = -contact.gap_m;
    reading.with = CollisionWith::kSolid;
    reading.other = contact.surface.label;
  }
}

void CollisionFinder::find_mover(const Body& body, OwnerSort sort, std::uint32_t other,
                                 const PhysicsState& state, CollisionReading& reading) const {
  const Body that = this->body(sort, other, state);
  const auto gap =
      sim::shape_gap(body.shape, body.world_from_body, that.shape, that.world_from_body, kApart_m);
  if (!gap || -gap->gap_m <= reading.depth_m) return;
  reading.point_m = gap->point_m;
  reading.normal = gap->normal;
  reading.depth_m = -gap->gap_m;
  reading.with = sort == OwnerSort::kVehicle ? CollisionWith::kVehicle : CollisionWith::kDiver;
  reading.other = other;
}

CollisionReading CollisionFinder::find(OwnerSort sort, std::uint32_t owner,
                                       const PhysicsState& state) {
  const bool vehicle = sort == OwnerSort::kVehicle;
  const ContactState& contact =
      vehicle ? state.vehicles()[owner].contact : state.humans()[owner].contact;
  CollisionReading reading{.depth_m = kNothing_m};
  const Body own = body(sort, owner, state);
  find_solid(own, reading);
  for (std::uint32_t i = 0; i < world_.vehicles().size(); ++i)
    if (!vehicle || i != owner) find_mover(own, OwnerSort::kVehicle, i, state, reading);
  for (std::uint32_t i = 0; i < world_.humans().size(); ++i)
    if (vehicle || i != owner) find_mover(own, OwnerSort::kDiver, i, state, reading);
  reading.depth_m = std::max(reading.depth_m, 0.0);
  if (reading.with == CollisionWith::kSolid) reading.impulse_n_s = contact.impulse_n_s;
  return reading;
}

}  // namespace neritic::testbed
