#include "rov/navigation_measurements.hpp"

#include <algorithm>
#include <cmath>

#include "rov/controller.hpp"

namespace neritic::rov {
namespace {

// How much a vehicle is taken to accelerate while it is levelled; and between a fix and its
// arrival.
constexpr double kStartAcceleration_m_s2 = 0.2, kFixAcceleration_m_s2 = 0.3;
// Above this depth a pressure sensor may be out of the water, where it reads 0.
constexpr double kWet_m = 0.1;
constexpr double kLeastRange_m = 0.01, kLeastAngle_rad = 1e-3;

void put(std::array<double, kErrors>& row, std::size_t place, const Vec3& v) {
  row[place] = v.x, row[place + 1] = v.y, row[place + 2] = v.z;
}

// The offset of something on the body from the inertial unit, NED axes.
Vec3 offset_ned(const NavigationModel& model, const NavigationState& state, const Vec3& body_m) {
  return state.attitude * (body_m - model.imu.mount.position_m);
}

double squared(double x) {
  return x * x;
}

double wrapped(double angle) {
  return std::remainder(angle, 2.0 * kPi);
}

}  // namespace

Measurement level_measurement(const NavigationModel& model, const NavigationState& state) {
  // f = R^T (a - g) + bias with an unknown a; d(R^T u) = R^T (u x e).
  const Quat body_from_ned = glm::conjugate(state.attitude);
  const Vec3 up(0.0, 0.0, -model.imu.gravity_m_s2);
  const Vec3 force = state.imu.specific_force_m_s2;
  const Vec3 expected = body_from_ned * up + state.bias3(kAccelerometerBias);
  // A force that is not gravity's says that it accelerates: upright by the difference, level by the
  // root of that of the squares.
  const double gravity = model.imu.gravity_m_s2;
  const double odd = std::abs(glm::length(force) - gravity);
  const double level_square =
      odd > kStartAcceleration_m_s2 ? std::abs(glm::dot(force, force) - gravity * gravity) : 0.0;
  const double variance = kStartAcceleration_m_s2 * kStartAcceleration_m_s2 + odd * odd +
                          level_square +
                          model.imu.accelerometer.white * model.imu.accelerometer.white;
  Measurement out;
  out.count = 3;
  out.of = kAttitudeError;
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    Vec3 unit(0.0);
    unit[axis] = 1.0;
    out.innovation[i] = force[axis] - expected[axis];
    // c . (u x e) = (c x u) . e
    put(out.change[i], kAttitudeError, glm::cross(state.attitude * unit, up));
    out.change[i][kAccelerometerBias + i] = 1.0;
    out.noise[i][i] = variance;
  }
  return out;
}

Measurement beam_measurement(const NavigationModel& model, const NavigationState& state,
                             std::size_t beam, double speed_m_s) {
  const Dvl& dvl = *model.dvl;
  const Vec3 along = dvl.mount.rotation * dvl_beam(dvl, beam);  // body axes
  const Vec3 along_ned = state.attitude * along;
  const Vec3 arm = dvl.mount.position_m - model.imu.mount.position_m;
  const Vec3 turning = state.imu.angular_rad_s - state.bias3(kGyroBias);
  const double scale = 1.0 + state.bias[kBeamScale - kFirstBias];
  const double speed =
      glm::dot(along_ned, state.velocity_ned_m_s) + glm::dot(along, glm::cross(turning, arm));
  const double expected = scale * speed + state.bias[kBeamBias - kFirstBias + beam];
  Measurement out;
  out.of = kVelocityError;
  out.innovation[0] = speed_m_s - expected;
  put(out.change[0], kVelocityError, scale * along_ned);
  // c . R^T (v x e) = (R c x v) . e; c . (-b x r) = -(r x c) . b
  put(out.change[0], kAttitudeError, scale * glm::cross(along_ned, state.velocity_ned_m_s));
  put(out.change[0], kGyroBias, -scale * glm::cross(arm, along));
  out.change[0][kBeamScale] = speed;
  out.change[0][kBeamBias + beam] = 1.0;
  const double gyro = model.imu.gyro.white * glm::length(arm);
  out.noise[0][0] = beam_variance(dvl, expected) + gyro * gyro +
                    squared(second_order(state, state.velocity_ned_m_s));
  return out;
}

Measurement depth_measurement(const NavigationModel& model, const NavigationState& state,
                              double depth_m) {
  const PressureSensor& sensor = *model.pressure;
  const Vec3 arm = offset_ned(model, state, sensor.mount.position_m);
  const double depth = state.position_ned_m.z + arm.z;
  const double scale = 1.0 + state.bias[kPressureScale - kFirstBias];
  Measurement out;
  out.of = kPositionError;
  out.innovation[0] = depth_m - (scale * depth + state.bias[kPressureBias - kFirstBias]);
  out.change[0][kPositionError + 2] = scale;
  // (e x r).z
  put(out.change[0], kAttitudeError, scale * Vec3(arm.y, -arm.x, 0.0));
  out.change[0][kPressureBias] = 1.0;
  out.change[0][kPressureScale] = depth;
  // The product of the errors of scale and depth (Bar-Shalom, Li, Kirubarajan 2001, section 10.3):
  // matters where the scale may be off by several percent.
  constexpr std::size_t z = kPositionError + 2;
  const double both = state.covariance(z, kPressureScale);
  const double product =
      state.covariance(kPressureScale, kPressureScale) * state.covariance(z, z) + both * both;
  out.noise[0][0] = depth_variance(sensor) + product + squared(second_order(state, arm)) +
                    (depth_m < kWet_m ? kWet_m * kWet_m : 0.0);
  return out;
}

bool has_heading(const NavigationState& state) {
  const Vec3 bow = state.attitude * Vec3(1.0, 0.0, 0.0);
  return std::hypot(bow.x, bow.y) > 0.342;
}

Measurement heading_measurement(const NavigationModel& model, const NavigationState& state,
                                double heading_rad) {
  const Compass& compass = *model.compass;
  const Vec3 bow = state.attitude * Vec3(1.0, 0.0, 0.0);
  const double level = std::max(bow.x * bow.x + bow.y * bow.y, 1e-12);
  const double heading = heading_of(state.attitude);
  const double* abc = &state.bias[kCompassBias - kFirstBias];
  const double sine = std::sin(heading), cosine = std::cos(heading);
  const double expected =
      heading - compass.declination_rad + abc[0] + abc[1] * sine + abc[2] * cosine;
  // The heading is atan2(bow.y, bow.x), and the bow turns by e x bow.
  const double by_heading = 1.0 + abc[1] * cosine - abc[2] * sine;
  Measurement out;
  out.of = kAttitudeError;
  out.innovation[0] = wrapped(heading_rad - expected);
  put(out.change[0], kAttitudeError,
      by_heading * Vec3(-bow.z * bow.x / level, -bow.z * bow.y / level, 1.0));
  put(out.change[0], kCompassBias, {1.0, sine, cosine});
  // A tilt that is hardly known turns the heading to second order too, by the product of its two
  // parts.
  const double tilt_variance = 0.5 * (state.covariance(0, 0) + state.covariance(1, 1));
  out.noise[0][0] = compass_variance(compass) + squared(tilt_variance);
  return out;
}

Measurement fix_measurement(const NavigationModel& model, const NavigationState& state,
                            const UsblReading& reading, double age_s) {
  const Usbl& usbl = *model.usbl;
  const Vec3 arm = offset_ned(model, state, usbl.beacon_m);
  const Vec3 expected = state.position_ned_m + arm - age_s * state.velocity_ned_m_s;
  const Vec3 line = expected - usbl.transceiver_ned_m;
  const double range = std::max(glm::length(line), kLeastRange_m);
  const Vec3 out_along = glm::length(line) > 0.0 ? line / glm::length(line) : Vec3(0.0, 0.0, 1.0);
  // Level and across the line of sight; and across both, upwards turned by increasing elevation.
  const double level = std::hypot(out_along.x, out_along.y);
  const Vec3 across = level > 1e-9 ? Vec3(-out_along.y, out_along.x, 0.0) / level : Vec3(0, 1, 0);
  const Vec3 steeper = glm::cross(out_along, across);
  const double* bias = &state.bias[kUsblBias - kFirstBias];
  const double along_m = bias[0] + range * state.bias[kRangeScale - kFirstBias];
  const Vec3 error = along_m * out_along + range * (bias[1] * across + bias[2] * steeper);
  const Vec3 innovation = reading.position_ned_m - expected - error;
  const double bent = squared(second_order(state, arm)) + squared(kLeastRange_m);
  const double along_variance = squared(usbl.range_noise.white) + bent;
  const double across_variance =
      squared(range) * (squared(usbl.direction_noise.white) + squared(kLeastAngle_rad * 0.1)) +
      bent;
  const double moved = 0.5 * kFixAcceleration_m_s2 * age_s * age_s;
  Measurement out;
  out.count = 3;
  out.of = kPositionError;
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    Vec3 unit(0.0);
    unit[axis] = 1.0;
    out.innovation[i] = innovation[axis];
    out.change[i][kPositionError + i] = 1.0;
    out.change[i][kVelocityError + i] = -age_s;
    // unit . (e x r) = (r x unit) . e
    put(out.change[i], kAttitudeError, glm::cross(arm, unit));
    put(out.change[i], kUsblBias, {out_along[axis], range * across[axis], range * steeper[axis]});
    out.change[i][kRangeScale] = range * out_along[axis];
    for (std::size_t j = 0; j < 3; ++j) {
      const int other = static_cast<int>(j);
      const double projected = out_along[axis] * out_along[other];
      out.noise[i][j] = along_variance * projected +
                        across_variance * ((i == j ? 1.0 : 0.0) - projected) +
                        (i == j ? moved * moved : 0.0);
    }
  }
  return out;
}

}  // namespace neritic::rov
