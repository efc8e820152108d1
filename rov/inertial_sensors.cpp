#include "rov/inertial_sensors.hpp"

#include <cmath>

#include "rov/controller.hpp"

namespace neritic::rov {

ImuReading read_imu(const Imu& imu, const Vehicle& vehicle, const State& state, const Vec6& contact,
                    const NoiseSource& noise, std::uint64_t sample) {
  const Vec6 rate = derivative(vehicle, state, state.held).velocity + contact;
  const Vec3 w = state.velocity.angular(), turning = rate.angular();
  const Vec3 r = imu.mount.position_m;
  // Velocity of the point r, in body axes: the origin's, plus the part of the rotation.
  const Vec3 acceleration = rate.linear() + glm::cross(w, state.velocity.linear()) +
                            glm::cross(turning, r) + glm::cross(w, glm::cross(w, r));
  const Vec3 gravity = glm::conjugate(state.attitude) * Vec3(0.0, 0.0, imu.gravity_m_s2);
  const Quat sensor_from_body = glm::conjugate(imu.mount.rotation);
  return {sensor_from_body * w + noise.error3(imu.gyro, 0, sample, imu.rate_hz),
          sensor_from_body * (acceleration - gravity) +
              noise.error3(imu.accelerometer, 3, sample, imu.rate_hz)};
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
