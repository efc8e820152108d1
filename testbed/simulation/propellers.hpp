// The propellers of a vehicle's model: nodes `propeller_0` and so on, which turn about their own z
// as the thrusters of these numbers push (tools/assets/README.md). Pictures and sonars show them;
// nothing of the physics reads their turns. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/scene/model.hpp"
#include "engine/scene/node_motion.hpp"
#include "rov/propeller.hpp"
#include "testbed/simulation/physics_state.hpp"

namespace neritic::testbed {

struct DrawnPropeller {
  std::uint32_t thruster = 0;  // of the vehicle
  int node = 0;                // of the model
  double sense = 1.0;  // 1: it turns about +z where the thrust is along the direction; or -1
  Quat rotation{1.0, 0.0, 0.0, 0.0};  // of the model at rest
  Vec3 scale{1.0};
};

// By number; of thrusters that the vehicle has. The pitch of the blades of a node's mesh says which
// way it turns: one without pitch turns about +z. A node that the file gives as a matrix stands.
std::vector<DrawnPropeller> drawn_propellers(const scene::Model& model,
                                             const rov::Vehicle& vehicle);

// After a step of dt_s that ended with these forces, one a thruster.
PropellerState next_propellers(const rov::Vehicle& vehicle, std::span<const double> forces_n,
                               double water_kg_m3, double dt_s, const PropellerState& before);

// The nodes of these propellers, in their order.
scene::NodeKey drawn_turns(const std::vector<DrawnPropeller>& propellers,
                           const rov::Vehicle& vehicle, const rov::State& body, double water_kg_m3,
                           const PropellerState& state, double time_s);

}  // namespace neritic::testbed
