#include "testbed/simulation/surface.hpp"

#include <algorithm>

namespace neritic::testbed {

void apply_surface(const rov::Vehicle& vehicle, double top_m, double bottom_m,
                   const rov::State& state, double head_m, rov::Inputs& inputs) {
  const double depth_m = state.position_ned_m.z + head_m;
  const double above_m = top_m - depth_m;
  if (!(above_m > 0.0)) return;
  const double share = std::min(1.0, above_m / (top_m - bottom_m));
  // Buoyancy, and the pull of accelerating water on what it would displace.
  const Vec3 lost_n = glm::conjugate(state.attitude) *
                      (Vec3(0.0, 0.0, share * vehicle.buoyancy_n) -
                       share * vehicle.displaced_kg * inputs.water_acceleration_ned_m_s2);
  inputs.wrench = inputs.wrench + rov::vec6(lost_n, glm::cross(vehicle.buoyancy_centre_m, lost_n));
  for (std::size_t i = 0; i < vehicle.thruster_count; ++i) {
    const Vec3 arm_m = state.attitude * vehicle.thrusters[i].position_m;
    if (depth_m + arm_m.z < 0.0) inputs.thruster_n[i] = 0.0;
  }
}

}  // namespace neritic::testbed
