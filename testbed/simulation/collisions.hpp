// Finds what a vehicle or diver touches, for the samples of its collisions: the nearest thing where
// the step ended. Asked only for a body that touched something in the step. Its memory is kept from
// call to call; one thread at a time.
#pragma once

#include "engine/sim/contact_memory.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

class CollisionFinder {
 public:
  // Borrows the world.
  explicit CollisionFinder(const PhysicsWorld& world) : world_(world) {}

  // Precondition: the body touched something in the step that ends at this state.
  CollisionReading find(OwnerSort sort, std::uint32_t owner, const PhysicsState& state);

 private:
  struct Body {
    const sim::BodyShape& shape;
    Pose world_from_body;
  };
  Body body(OwnerSort sort, std::uint32_t owner, const PhysicsState& state) const;
  void find_solid(const Body& body, CollisionReading& reading);
  void find_mover(const Body& body, OwnerSort sort, std::uint32_t other, const PhysicsState& state,
                  CollisionReading& reading) const;

  const PhysicsWorld& world_;
  sim::ContactMemory memory_;
};

}  // namespace neritic::testbed
