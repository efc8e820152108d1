// Where a navigation starts, or begins anew once it is lost. NED and body axes. Pure functions
// without allocation; any thread.
#pragma once

#include <optional>

#include "rov/navigation_model.hpp"

namespace neritic::rov {

// Speeds beyond this no vehicle has.
inline constexpr double kMostSpeed_m_s = 50.0;
// Where it begins anew the velocity is known so well, in each axis: 99.9 % of vehicles are slower
// than 6 m/s.
inline constexpr double kAnewSigma_m_s = 2.0;

// Level by the force, as that of a body that feels gravity alone (Groves 2013, eq. 5.101).
Quat levelled(const Vec3& force, double heading_rad);
// By the compass, where it has read.
std::optional<double> heading_by(const NavigationModel& model, const SensorReadings& readings);
// The covariance of a state whose attitude is not known, velocity and position are within these
// standard deviations, and biases are as the sensors' specification has them.
void know_only(const NavigationModel& model, double velocity_m_s, double position_m,
               NavigationState& state);
// Levels the state by its inertial reading, whatever it was before.
void level(const NavigationModel& model, NavigationState& state);

// A lost navigation begins anew: nothing of its covariance was true. Level by the inertial unit,
// heading by the compass, velocity by the DVL where all of its beams hear; the position is left
// where it is, within position_m: the caller's to correct.
void begin_anew(const NavigationModel& model, const SensorReadings& readings, double position_m,
                NavigationState& state);

}  // namespace neritic::rov
