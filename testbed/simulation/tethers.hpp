// The tethers of a scene's vehicles that name one: a cable (rov/cable.hpp) from its top, in the
// world or on an object, to the vehicle; along what is solid; with its winch. Built once, then only
// read: any thread may step. World axes at this border, north, east, down inside.
#pragma once

#include "engine/sim/contact_memory.hpp"
#include "engine/sim/motion.hpp"
#include "testbed/simulation/places.hpp"

namespace neritic::testbed {

struct PhysicsTether {
  std::string name;         // its vehicle's
  std::size_t vehicle = 0;  // of PhysicsState::vehicles()
  std::size_t object = 0;   // of the scene, as which it is drawn
  rov::Cable cable;
  scene::Tether settings;
  std::size_t first_node = 0;  // of PhysicsState::tether_nodes(); segments - 1 of them
  Place top;
};

// Memory of a step; its content means nothing between steps.
struct TetherScratch {
  rov::CableWork work;
  std::vector<Vec3> currents;
  std::vector<rov::CableContact> contacts;
};
// The vehicle at its end: its motion after the step as if there were no tether, changed by it.
struct TetheredBody {
  const sim::InverseMass& inverse_mass;
  Pose before;
  Vec3 velocity_before_m_s{0.0};  // of its origin, world axes
  Vec3 turning_before_rad_s{0.0};
  sim::BodyMotion& free;
};

class Tethers {
 public:
  // Errors in one line. Borrows movers.
  static Result<Tethers> create(const scene::Scene& scene, const Movers& movers);

  bool any() const { return !all_.empty(); }
  const std::vector<PhysicsTether>& all() const { return all_; }
  std::size_t node_count() const { return nodes_; }
  std::span<const rov::CableNode> nodes(const PhysicsState& state, std::size_t tether) const;

  // Refuses, in one line, a tether too short for its vehicle's start.
  Status check_lengths(const PhysicsState& start) const;

  // At rest as in still water, and on what is solid.
  void start(const sim::StaticWorld& solid, PhysicsState& state) const;
  // One step of one tether. current(place_ned_m): of the water. Whether it pulled at the body.
  template <class CurrentAt>
  bool step(std::size_t tether, const sim::StaticWorld& solid, const CurrentAt& current,
            const PhysicsState& before, const sim::StepTime& time, TetheredBody body,
            TetherScratch& scratch, sim::ContactMemory& memory, PhysicsState& after) const {
    scratch.currents.clear();
    scratch.currents.push_back(current(before.tethers()[tether].top_ned_m));
    for (const rov::CableNode& node : nodes(before, tether))
      scratch.currents.push_back(current(node.position_ned_m));
    scratch.currents.push_back(current(before.tethers()[tether].end_ned_m));
    return step(tether, solid, before, time, body, scratch, memory, after);
  }

 private:
  bool step(std::size_t tether, const sim::StaticWorld& solid, const PhysicsState& before,
            const sim::StepTime& time, TetheredBody body, TetherScratch& scratch,
            sim::ContactMemory& memory, PhysicsState& after) const;

  std::vector<PhysicsTether> all_;
  std::size_t nodes_ = 0;
};

TetherReading tether_reading(const TetherState& state);
// The joints of the drawn tube, in the axes of the world about the top (scene::make_tube).
scene::NodeKey drawn_tether(std::span<const rov::CableNode> nodes, const TetherState& state,
                            double time_s);

}  // namespace neritic::testbed
