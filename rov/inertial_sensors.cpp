#include "rov/inertial_sensors.hpp"

#include <cmath>

#include "rov/controller.hpp"

namespace neritic::rov {
namespace {

ImuReading with_noise(const Imu& imu, const Vec3& angular_rad_s, const Vec3& force_m_s2,
                      const NoiseSource& noise, std::uint64_t sample) {
  const Quat sensor_from_body = glm::conjugate(imu.mount.rotation);
  return {sensor_from_body * angular_rad_s + noise.error3(imu.gyro, 0, sample, imu.rate_hz),
          sensor_from_body * force_m_s2 + noise.error3(imu.accelerometer, 3, sample, imu.rate_hz)};
}

}  // namespace

InertialMotion inertial_motion(const Imu& imu, const State& state, double time_s) {
  const Vec3 moving =
      state.velocity.linear() + glm::cross(state.velocity.angular(), imu.mount.position_m);
  return {time_s, state.attitude, state.attitude * moving};
}

ImuReading mean_imu(const Imu& imu, const InertialMotion& from, const InertialMotion& to,
                    const NoiseSource& noise, std::uint64_t sample) {
  const double dt_s = to.time_s - from.time_s;
  const Vec3 turned = rotation_vector(glm::conjugate(from.attitude) * to.attitude);
  const double angle = glm::length(turned);
  const Quat half_way =
      angle > 0.0 ? from.attitude * glm::angleAxis(0.5 * angle, turned / angle) : from.attitude;
  const Vec3 force_ned =
      (to.velocity_ned_m_s - from.velocity_ned_m_s) / dt_s - Vec3(0.0, 0.0, imu.gravity_m_s2);
  return with_noise(imu, turned / dt_s, glm::conjugate(half_way) * force_ned, noise, sample);
}

ImuReading read_imu(const Imu& imu, const Vehicle& vehicle, const State& state, const Vec6& contact,
                    const NoiseSource& noise, std::uint64_t sample) {
  const Vec6 rate = derivative(vehicle, state, state.held).velocity + contact;
  const Vec3 w = state.velocity.angular(), turning = rate.angular();
  const Vec3 r = imu.mount.position_m;
  // Velocity of the point r, in body axes: the origin's, plus the part of the rotation.
  const Vec3 acceleration = rate.linear() + glm::cross(w, state.velocity.linear()) +
                            glm::cross(turning, r) + glm::cross(w, glm::cross(w, r));
  const Vec3 gravity = glm::conjugate(state.attitude) * Vec3(0.0, 0.0, imu.gravity_m_s2);
  return with_noise(imu, w, acceleration - gravity, noise, sample);
}

double SensorWater::pressure_pa(double depth_m) const {
  const double above_kg_m2 =
      layers ? layers->mass_above_kg_m2(depth_m) : water_kg_m3 * std::max(0.0, depth_m);
  return air_pa + gravity_m_s2 * above_kg_m2;
}

PressureReading read_pressure(const PressureSensor& sensor, const SensorWater& water,
                              const State& state, const NoiseSource& noise, std::uint64_t sample) {
  const Vec3 at = state.position_ned_m + state.attitude * sensor.mount.position_m;
  double pressure =
      water.pressure_pa(at.z + water.head_m) + noise.error(sensor.noise, 0, sample, sensor.rate_hz);
  if (sensor.resolution_pa > 0.0)
    pressure = sensor.resolution_pa * std::round(pressure / sensor.resolution_pa);
  return {pressure, (pressure - sensor.surface_pa.value_or(water.air_pa)) /
                        (sensor.water_kg_m3 * sensor.gravity_m_s2)};
}

double read_compass(const Compass& compass, const State& state, const NoiseSource& noise,
                    std::uint64_t sample) {
  const double heading = heading_of(state.attitude);
  const double read = heading - compass.declination_rad +
                      compass.deviation_rad * std::sin(heading - compass.deviation_phase_rad) +
                      noise.error(compass.noise, 0, sample, compass.rate_hz);
  const double turns = read / (2.0 * kPi);
  const double wrapped = 2.0 * kPi * (turns - std::floor(turns));
  return wrapped < 2.0 * kPi ? wrapped : 0.0;
}

}  // namespace neritic::rov
