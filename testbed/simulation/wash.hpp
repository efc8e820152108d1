// The wash of a scene's vehicles that name it: what it does to divers, to things and to the thrust
// itself near what is solid (rov/wash.hpp). Pure functions of the state before a step; any thread.
// North, east, down.
#pragma once

#include <span>

#include "rov/sensor_set.hpp"
#include "testbed/simulation/human_world.hpp"

namespace neritic::testbed {

struct PhysicsVehicle;

// The sum of all jets at a point; those of a vehicle that is not beyond its reach.
Vec3 wash_ned_m_s(std::span<const PhysicsVehicle> vehicles, const PhysicsState& before,
                  const Vec3& point_ned_m, double water_kg_m3);
// The one flow that drags a diver's body as the jets along it do, by the mean of u |u|.
Vec3 wash_on_diver_ned_m_s(std::span<const PhysicsVehicle> vehicles, const PhysicsHuman& human,
                           const HumanPhysics& diver, const PhysicsState& before,
                           double water_kg_m3);
// More thrust towards what is solid near it, as a wrench in inputs.
void add_ground_effect(const PhysicsVehicle& vehicle, const rov::RayQuery& rays,
                       const rov::State& state, rov::Inputs& inputs);

}  // namespace neritic::testbed
