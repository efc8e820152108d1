// The arithmetic of the error-state Kalman filter (navigation_state.hpp): motion by the inertial
// unit, corrections by measurements, an outlier test. It knows no sensor. NED and body axes. Pure
// functions without allocation; any thread.
//
// Motion: Solà 2017, section 7.2 (global angular errors), in discrete time; the rotation of the
// Earth is left out, as the simulated gyros do not feel it. Corrections: Joseph's form (Bucy and
// Joseph 1968; Groves 2013, eq. 3.58), evaluated as a product, so that rounding cannot take the
// covariance's sign away; its reset by the attitude's correction (Solà, eq. 287) is left out, being
// of second order in it.
#pragma once

#include "rov/navigation_state.hpp"

namespace neritic::rov {

// Variances that the covariance gathers per second, in each axis.
struct MotionNoise {
  double gyro = 0.0;                                // rad^2/s, of the angle
  double accelerometer = 0.0;                       // m^2/s^3, of the velocity
  std::array<double, kErrors - kFirstBias> walk{};  // of the biases, their unit squared a second
};

// Moves attitude, velocity and position by dt_s with the mean inertial reading of that time: body
// axes, biases included. Nothing moves where dt_s is not above 0.
void move(NavigationState& state, const ImuReading& mean, double gravity_m_s2, double dt_s);
// The same without a reading, silent_s after the last: the vehicle neither turns nor accelerates,
// as far as is known. It may have turned by 0.5 rad/s, tilted by 0.05 rad/s and gained 0.5 m/s a
// second since.
void coast(NavigationState& state, double silent_s, double dt_s);

// The error after a move, as a matrix on the error before: rows of attitude, velocity, position;
// columns up to the gyros' biases. The others stay as they are.
using Transition = std::array<std::array<double, kBeamBias>, kFirstBias>;
Transition transition(const NavigationState& state);

// How far a vector that is known in body axes may be off in NED, beyond the first order of the
// attitude's error e: the root mean square of e x (e x v) / 2, of normal errors (Bar-Shalom, Li,
// Kirubarajan 2001, section 10.3.2). Negligible below some degrees; of an attitude that is hardly
// known it keeps the first precise measurement from being taken for more than it tells.
// Precondition: as of the covariance's time.
double second_order(const NavigationState& state, const Vec3& v_ned);

// Moves the covariance to the state's time.
void move_covariance(NavigationState& state, const MotionNoise& noise);

// Up to three numbers that were measured at once: measured less expected, how that changes with the
// errors, and the covariance of its noise.
struct Measurement {
  std::size_t count = 1;
  std::array<double, 3> innovation{};
  std::array<std::array<double, kErrors>, 3> change{};
  std::array<std::array<double, 3>, 3> noise{};
  // Where the three errors are that it measures in the first place.
  std::size_t of = kPositionError;
};

// The innovation's square over its variance, which follows the chi-square distribution of
// measurement.count; negative where that is no number.
double normalized_innovation_squared(const NavigationState& state, const Measurement& measurement);
// Beyond this 0.1 % of correct measurements lie: quantiles of the chi-square distribution.
double outlier_bound(std::size_t count);

// Corrects the state by the measurement, unless it is refused (not finite) or rejected (beyond the
// outlier bound). After patience rejections in a row the filter takes itself for wrong: it adds the
// innovation to the uncertainty of what is measured, and accepts. Precondition: the covariance is
// of the state's time. Returns whether it was accepted.
bool correct(NavigationState& state, const Measurement& measurement, AidTally& tally,
             std::uint64_t patience);

// The state moved by an error.
void add_error(NavigationState& state, const std::array<double, kErrors>& error);
// The rotation by a vector, radians.
Quat rotation_by(const Vec3& angle);

}  // namespace neritic::rov
