#include "testbed/simulation/wash.hpp"

#include <algorithm>
#include <cmath>

#include "rov/wash.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {
namespace {

// Along the body, shares of the height from the hips: feet, knees, hips, chest, head.
constexpr double kWashedAt[] = {-0.45, -0.25, 0.0, 0.22, 0.42};
// Ground effect ends where it is below 1e-4: D / 8 z = 0.01.
constexpr double kGroundReach = 12.5;  // diameters

template <class Visit>
void each_jet(const PhysicsVehicle& vehicle, const rov::State& state, const Visit& visit) {
  const auto forces_n = rov::thruster_forces(vehicle.vehicle, state, state.held);
  for (std::size_t i = 0; i < vehicle.vehicle.thruster_count; ++i) {
    if (forces_n[i] == 0.0) continue;
    const rov::Thruster& thruster = vehicle.vehicle.thrusters[i];
    const double sign = forces_n[i] > 0.0 ? 1.0 : -1.0;
    visit(i, rov::WashJet{state.position_ned_m + state.attitude * thruster.position_m,
                          state.attitude * (-sign * thruster.direction), std::abs(forces_n[i]),
                          vehicle.wash->diameter_m});
  }
}

}  // namespace

Vec3 wash_ned_m_s(std::span<const PhysicsVehicle> vehicles, const PhysicsState& before,
                  const Vec3& point_ned_m, double water_kg_m3) {
  Vec3 sum(0.0);
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    if (!vehicles[i].wash) continue;
    const rov::State& state = before.vehicles()[i].body;
    if (glm::distance(state.position_ned_m, point_ned_m) > vehicles[i].wash->reach_m) continue;
    each_jet(vehicles[i], state, [&](std::size_t, const rov::WashJet& jet) {
      sum += rov::jet_velocity_m_s(jet, point_ned_m, water_kg_m3);
    });
  }
  return sum;
}

Vec3 wash_on_diver_ned_m_s(std::span<const PhysicsVehicle> vehicles, const PhysicsHuman& human,
                           const HumanPhysics& diver, const PhysicsState& before,
                           double water_kg_m3) {
  const diver::RootState& root = diver.human.root;
  Vec3 drag(0.0);
  for (const double share : kWashedAt) {
    const Vec3 at =
        root.position_ned_m + root.attitude * Vec3(share * human.body.height_m, 0.0, 0.0);
    const Vec3 u = wash_ned_m_s(vehicles, before, at, water_kg_m3);
    drag += glm::length(u) * u / static_cast<double>(std::size(kWashedAt));
  }
  const double size = glm::length(drag);
  return size > 0.0 ? drag / std::sqrt(size) : Vec3(0.0);
}

void add_ground_effect(const PhysicsVehicle& vehicle, const rov::RayQuery& rays,
                       const rov::State& state, rov::Inputs& inputs) {
  const double most_m = kGroundReach * vehicle.wash->diameter_m;
  each_jet(vehicle, state, [&](std::size_t i, const rov::WashJet& jet) {
    const double far_m = rays.cast(rays.context, jet.from_m, jet.along, most_m);
    if (!(far_m <= most_m)) return;
    const double more_n = (rov::ground_effect(jet.diameter_m, far_m) - 1.0) * jet.thrust_n;
    const bool forward =
        glm::dot(jet.along, state.attitude * vehicle.vehicle.thrusters[i].direction) < 0.0;
    for (std::size_t k = 0; k < 6; ++k)
      inputs.wrench[k] += (forward ? more_n : -more_n) * vehicle.vehicle.thruster_wrench[i][k];
  });
}

}  // namespace neritic::testbed
