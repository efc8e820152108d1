#include "rov/navigation_start.hpp"

#include <cmath>

#include "rov/controller.hpp"
#include "rov/navigation_measurements.hpp"

namespace neritic::rov {
namespace {

// The standard deviation of the attitude before the first measurement.
constexpr double kUnknown_rad = 1.0;

}  // namespace

void level(const NavigationModel& model, NavigationState& state) {
  move_covariance(state, model.motion);
  AidTally levelled;
  correct(state, level_measurement(model, state), levelled, 0);
}

Quat levelled(const Vec3& force, double heading_rad) {
  const double roll = std::atan2(-force.y, -force.z);
  const double pitch = std::atan2(force.x, std::hypot(force.y, force.z));
  return heading_attitude(heading_rad) * glm::angleAxis(pitch, Vec3(0.0, 1.0, 0.0)) *
         glm::angleAxis(roll, Vec3(1.0, 0.0, 0.0));
}

std::optional<double> heading_by(const NavigationModel& model, const SensorReadings& readings) {
  const double read = readings.heading_rad.value;
  if (!model.compass || readings.heading_rad.count == 0 || !(std::abs(read) <= 10.0 * kPi))
    return std::nullopt;
  return read + model.compass->declination_rad;
}

void know_only(const NavigationModel& model, double velocity_m_s, double position_m,
               NavigationState& state) {
  state.covariance = {};
  for (std::size_t i = 0; i < 3; ++i) {
    state.covariance.set(kAttitudeError + i, kAttitudeError + i, kUnknown_rad * kUnknown_rad);
    state.covariance.set(kVelocityError + i, kVelocityError + i, velocity_m_s * velocity_m_s);
    state.covariance.set(kPositionError + i, kPositionError + i, position_m * position_m);
  }
  for (std::size_t i = kFirstBias; i < kErrors; ++i)
    state.covariance.set(i, i, model.bias_variance[i - kFirstBias]);
}

void begin_anew(const NavigationModel& model, const SensorReadings& readings, double position_m,
                NavigationState& state) {
  ++state.begun_anew;
  state.begun_anew_s = state.time_s;
  state.attitude = levelled(state.imu.specific_force_m_s2,
                            heading_by(model, readings).value_or(heading_of(state.attitude)));
  state.bias = {};
  const DvlReading& dvl = readings.dvl.value;
  const bool hears = model.dvl && readings.dvl.count > 0 && dvl.hears(0) && dvl.hears(1) &&
                     dvl.hears(2) && dvl.hears(3) &&
                     is_finite_within(dvl.velocity_m_s, kMostSpeed_m_s);
  state.velocity_ned_m_s =
      hears ? state.attitude * model.dvl->mount.rotation * dvl.velocity_m_s : Vec3(0.0);
  state.pending_s = 0.0;
  state.pending_ned_m_s = Vec3(0.0);
  for (AidTally& aid : state.aids) aid.rejected_in_a_row = 0;
  know_only(model, kAnewSigma_m_s, position_m, state);
  level(model, state);
  if (heading_by(model, readings) && has_heading(state)) {
    AidTally turned;
    correct(state, heading_measurement(model, state, readings.heading_rad.value), turned, 0);
  }
}

}  // namespace neritic::rov
