#include "rov/sensor_set.hpp"

#include <algorithm>

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

// Contacts' mean rate over the time up to the sample that is due in (from_s, to_s], what is left of
// this step being the next sample's; or nothing yet, where none is.
Vec6 mean_contact(const std::optional<Imu>& imu, const Vec6& contact, double from_s, double to_s,
                  SensorReadings& readings) {
  if (!imu) return {};
  const auto add = [&](double s) {
    readings.contact_change = readings.contact_change + s * contact;
    readings.contact_s += s;
  };
  const auto sample = sample_due(imu->rate_hz, from_s, to_s);
  if (!sample) {
    add(to_s - from_s);
    return {};
  }
  const double after_s =
      std::clamp(to_s - static_cast<double>(*sample) / imu->rate_hz, 0.0, to_s - from_s);
  add(to_s - from_s - after_s);
  const Vec6 mean =
      readings.contact_s > 0.0 ? (1.0 / readings.contact_s) * readings.contact_change : contact;
  readings.contact_change = {};
  readings.contact_s = 0.0;
  add(after_s);
  return mean;
}

}  // namespace

void update_readings(const SensorSet& sensors, const SensorWorld& world, const Vehicle& vehicle,
                     const State& state, const Vec6& contact, double from_s, double to_s,
                     SensorReadings& readings) {
  const Vec6 felt = mean_contact(sensors.imu, contact, from_s, to_s, readings);
  const auto with = [&](const auto& sensor, Stream stream, auto& reading, const auto& read) {
    update(sensor, world, stream, from_s, to_s, reading, read);
  };
  with(sensors.imu, kImu, readings.imu, [&](const Imu& s, const NoiseSource& n, std::uint64_t k) {
    return read_imu(s, vehicle, state, felt, n, k);
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
