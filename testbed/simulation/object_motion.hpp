// How the objects of a scene move that a simulation moves, out of one of its states: for histories
// and for missions. World axes. Pure functions; any thread.
#pragma once

#include <vector>

#include "engine/scene/motion.hpp"
#include "testbed/simulation/physics_state.hpp"

namespace neritic::testbed {

// World_from_object, as drawn: a diver's model stands.
Motion motion_of(const VehicleState& vehicle);
Motion motion_of(const HumanPhysics& human);
// Nothing while the object's own track or place has it.
std::optional<Motion> motion_of(const ObjectState& object);

// By object of the scene: its place among the state's vehicles, divers or objects; -1: none.
struct Movers {
  explicit Movers(const scene::Scene& scene);
  std::vector<int> vehicle_of_object, human_of_object, tracked_of_object;
};

// A state as what moves the objects of its scene, at the state's time. Borrows both.
class StateMotion final : public scene::SimulatedMotion {
 public:
  StateMotion(const Movers& movers, const PhysicsState& state) : movers_(movers), state_(state) {}
  std::optional<scene::MotionAt> at(std::size_t object, double time_s) const override;

 private:
  const Movers& movers_;
  const PhysicsState& state_;
};

}  // namespace neritic::testbed
