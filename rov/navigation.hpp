// Navigation by a vehicle's own sensors: an inertial unit whose motion DVL, pressure, compass and
// USBL correct, each at its rate, each with its own outlier test, and each free to fall silent. NED
// and body axes, about the body's origin. Pure functions without allocation; any thread.
//
//   const NavigationModel model = navigation_model(sensors);
//   NavigationState navigation = start_navigation(model, readings, where, seed_of_its_error);
//   ... each step: update_readings(...); update_navigation(model, readings, time_s, navigation);
//   control(... estimated_state(model, navigation, time_s, state.held) ...);
#pragma once

#include "rov/navigation_model.hpp"

namespace neritic::rov {

// The launch position is known so well, in each axis; a vehicle is launched at rest, within this.
inline constexpr double kLaunchSigma_m = 0.1, kLaunchSigma_m_s = 0.05;

// At the place of launch, as its operator knows it: level by the inertial unit, heading by the
// compass, corrected by whatever else the readings have.
NavigationState start_navigation(const NavigationModel& model, const SensorReadings& readings,
                                 const Vec3& launch_ned_m, double time_s);
// The launch position as the operator of this vehicle knows it: the true one, with an error.
Vec3 surveyed_launch(const Vec3& position_ned_m, std::uint64_t seed, std::uint64_t vehicle);

// Takes in the readings that are new at time_s. A USBL's fix arrives half its travel time late.
void update_navigation(const NavigationModel& model, const SensorReadings& readings, double time_s,
                       NavigationState& state);

// Pose and velocity as estimated, carried on to time_s; held: the commands that the vehicle knows,
// of the true ones; without the current, which it does not measure.
State estimated_state(const NavigationModel& model, const NavigationState& navigation,
                      double time_s, const State& known);

// The estimate of the body's origin, for logs and panels.
struct NavigationEstimate {
  Vec3 position_ned_m{0.0};
  Vec3 velocity_ned_m_s{0.0};
  Quat attitude{1.0, 0.0, 0.0, 0.0};
  // Standard deviations in NED axes; of the attitude as a rotation, rad.
  Vec3 position_sigma_m{0.0}, velocity_sigma_m_s{0.0}, attitude_sigma_rad{0.0};
};
NavigationEstimate estimate_of(const NavigationModel& model, const NavigationState& navigation);

}  // namespace neritic::rov
