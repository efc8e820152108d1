#include "rov/sensor_set.hpp"

#include <utility>

namespace neritic::rov {
namespace {

// Streams of random numbers within a vehicle.
enum Stream : std::uint64_t { kImu, kDvl, kPressure, kCompass, kAltimeter, kUsbl, kStreams };

// Asks the sensor, where there is one, if a sample of it is due.
template <class Sensor, class Value, class Read>
void update(const std::optional<Sensor>& sensor, const SensorWorld& world, Stream stream,
            double from_s, double to_s, Reading<Value>& reading, const Read& read) {
  if (!sensor) return;
  const auto sample = sample_due(sensor->rate_hz, from_s, to_s);
  if (!sample) return;
  const NoiseSource noise{world.seed, kStreams * world.vehicle + stream};
  reading.value = read(*sensor, noise, *sample);
  reading.time_s = static_cast<double>(*sample) / sensor->rate_hz;
  ++reading.count;
}

}  // namespace

void update_readings(const SensorSet& sensors, const SensorWorld& world, const Vehicle& vehicle,
                     const State& state, const Vec6& contact, double from_s, double to_s,
                     SensorReadings& readings) {
  const auto with = [&](const auto& sensor, Stream stream, auto& reading, const auto& read) {
    update(sensor, world, stream, from_s, to_s, reading, read);
  };
  with(sensors.imu, kImu, readings.imu, [&](const Imu& s, const NoiseSource& n, std::uint64_t k) {
    const InertialMotion now = inertial_motion(s, state, to_s);
    const InertialMotion from = std::exchange(readings.imu_from, now);
    return readings.imu.count > 0 && from.time_s < to_s
               ? mean_imu(s, from, now, n, k)
               : read_imu(s, vehicle, state, contact, n, k);
  });
  with(sensors.dvl, kDvl, readings.dvl, [&](const Dvl& s, const NoiseSource& n, std::uint64_t k) {
    return read_dvl(s, world.water, state, world.rays, n, k);
  });
  with(sensors.pressure, kPressure, readings.pressure,
       [&](const PressureSensor& s, const NoiseSource& n, std::uint64_t k) {
         return read_pressure(s, world.water, state, n, k);
       });
  with(sensors.compass, kCompass, readings.heading_rad,
       [&](const Compass& s, const NoiseSource& n, std::uint64_t k) {
         return read_compass(s, state, n, k);
       });
  with(sensors.altimeter, kAltimeter, readings.altimeter,
       [&](const Altimeter& s, const NoiseSource& n, std::uint64_t k) {
         return read_altimeter(s, world.water, state, world.rays, n, k);
       });
  with(sensors.usbl, kUsbl, readings.usbl,
       [&](const Usbl& s, const NoiseSource& n, std::uint64_t k) {
         return read_usbl(s, world.water, state, n, k);
       });
}

}  // namespace neritic::rov
