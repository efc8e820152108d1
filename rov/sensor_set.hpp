// The sensors of one vehicle and the newest reading of each. An absent sensor costs
// nothing. Pure functions; any thread.
#pragma once

#include <optional>

#include "rov/acoustic_sensors.hpp"

namespace neritic::rov {

struct SensorSet {
  std::optional<Imu> imu;
  std::optional<Dvl> dvl;
  std::optional<PressureSensor> pressure;
  std::optional<Compass> compass;
  std::optional<Altimeter> altimeter;
  std::optional<Usbl> usbl;
  bool any() const { return imu || dvl || pressure || compass || altimeter || usbl; }
};

// One sensor's newest reading. count: how many it made; 0: none yet.
template <class Value>
struct Reading {
  Value value{};
  double time_s = 0.0;
  std::uint64_t count = 0;
  static void fields(auto&& field, auto& self) {
    field("value", self.value);
    field("time_s", self.time_s);
    field("count", self.count);
  }
};

// Plain bytes, all of them finite: a part of a simulation's state.
struct SensorReadings {
  Reading<ImuReading> imu;
  Reading<DvlReading> dvl;
  Reading<PressureReading> pressure;
  Reading<double> heading_rad;
  Reading<AltimeterReading> altimeter;
  Reading<UsblReading> usbl;
  // The inertial unit's motion at its last reading.
  InertialMotion imu_from;
  static void fields(auto&& field, auto& self) {
    field("imu", self.imu);
    field("dvl", self.dvl);
    field("pressure", self.pressure);
    field("heading_rad", self.heading_rad);
    field("altimeter", self.altimeter);
    field("usbl", self.usbl);
    field("imu_from", self.imu_from);
  }
};

struct SensorWorld {
  RayQuery rays;              // without one, nothing is heard
  std::uint64_t seed = 0;     // of the scene
  std::uint64_t vehicle = 0;  // its number: vehicles differ in their noise
  SensorWater water{};
};

// Replaces the readings of the sensors that are due in (from_s, to_s], of the state at to_s. The
// inertial unit reads means since the state that it read last, so that no jolt is missed or felt
// twice, whatever its rate. contact: the rate of the velocity by contacts in that time, body axes,
// for its first reading.
void update_readings(const SensorSet& sensors, const SensorWorld& world, const Vehicle& vehicle,
                     const State& state, const Vec6& contact, double from_s, double to_s,
                     SensorReadings& readings);

}  // namespace neritic::rov
