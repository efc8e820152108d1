#include "testbed/simulation/surface.hpp"

#include <algorithm>

#include "rov/ventilation.hpp"

namespace neritic::testbed {
namespace {

void lose_buoyancy(const rov::Vehicle& vehicle, double share, const rov::State& state,
                   rov::Inputs& inputs) {
  // Buoyancy, and the pull of accelerating water on what it would displace.
  const Vec3 lost_n = glm::conjugate(state.attitude) *
                      (Vec3(0.0, 0.0, share * vehicle.buoyancy_n) -
                       share * vehicle.displaced_kg * inputs.water_acceleration_ned_m_s2);
  inputs.wrench = inputs.wrench + rov::vec6(lost_n, glm::cross(vehicle.buoyancy_centre_m, lost_n));
}

void ventilate(const rov::Vehicle& vehicle, double depth_m, const rov::State& state,
               rov::Inputs& inputs) {
  for (std::size_t i = 0; i < vehicle.thruster_count; ++i) {
    const rov::Thruster& thruster = vehicle.thrusters[i];
    const double share =
        rov::thrust_share(depth_m + (state.attitude * thruster.position_m).z,
                          0.5 * thruster.propeller_m, (state.attitude * thruster.direction).z);
    if (share < 1.0)
      inputs.thruster_n[i] =
          share * std::clamp(inputs.thruster_n[i], thruster.min_n, thruster.max_n);
  }
}

}  // namespace

void apply_surface(const rov::Vehicle& vehicle, double top_m, double bottom_m,
                   const rov::State& state, double head_m, rov::Inputs& inputs) {
  const double depth_m = state.position_ned_m.z + head_m;
  const double above_m = top_m - depth_m;
  if (above_m > 0.0)
    lose_buoyancy(vehicle, std::min(1.0, above_m / (top_m - bottom_m)), state, inputs);
  if (depth_m < vehicle.ventilates_m) ventilate(vehicle, depth_m, state, inputs);
}

}  // namespace neritic::testbed
