// Sensors that feel the vehicle itself: inertial measurement unit, pressure, compass. World axes
// north, east, down; body axes forward, starboard, down. Pure functions; any thread.
#pragma once

#include <optional>

#include "engine/core/layered_water.hpp"
#include "rov/dynamics.hpp"
#include "rov/sensor_noise.hpp"

namespace neritic::rov {

// Where a sensor sits, and how it is turned: body_from_sensor.
struct Mount {
  Vec3 position_m{0.0};
  Quat rotation{1.0, 0.0, 0.0, 0.0};
};

struct Imu {
  Mount mount;
  double rate_hz = 200.0;
  Noise gyro, accelerometer;  // rad/s, m/s^2
  double gravity_m_s2 = 9.82;
};
struct ImuReading {
  Vec3 angular_rad_s{0.0};
  // Specific force, acceleration less gravity: at rest and level (0, 0, -g).
  Vec3 specific_force_m_s2{0.0};
  static void fields(auto&& field, auto& self) {
    field("angular_rad_s", self.angular_rad_s);
    field("specific_force_m_s2", self.specific_force_m_s2);
  }
};
// Where a unit was in its motion when it read: its next reading is the mean from there.
struct InertialMotion {
  double time_s = 0.0;
  Quat attitude{1.0, 0.0, 0.0, 0.0};  // ned_from_body
  Vec3 velocity_ned_m_s{0.0};         // of the unit itself
  static void fields(auto&& field, auto& self) {
    field("time_s", self.time_s);
    field("attitude", self.attitude);
    field("velocity_ned_m_s", self.velocity_ned_m_s);
  }
};
InertialMotion inertial_motion(const Imu& imu, const State& state, double time_s);

// The mean from one instant to another, as units deliver it that integrate both (Savage 1998,
// "Strapdown inertial navigation integration algorithm design", coning and sculling taken off): the
// rotation vector between the attitudes over the time; and the change of velocity over the time,
// less gravity, in axes turned half the way. However short a jolt is, it is in the reading.
// Precondition: to is later than from.
ImuReading mean_imu(const Imu& imu, const InertialMotion& from, const InertialMotion& to,
                    const NoiseSource& noise, std::uint64_t sample);
// The same at an instant, as a unit's first reading is.
// contact: the rate of the velocity that contacts make, linear and angular, body axes; beside what
// water, weight and thrusters do at the state, which follow from it.
ImuReading read_imu(const Imu& imu, const Vehicle& vehicle, const State& state, const Vec6& contact,
                    const NoiseSource& noise, std::uint64_t sample);

// The water that a sensor is in, and the air over it: the scene's.
struct SensorWater {
  double water_kg_m3 = 1028.0, gravity_m_s2 = 9.82;
  double air_pa = 101325.0;
  double head_m = 0.0;  // of waves: the pressure is that of still water deeper by this much
  // The scene's, in place of water_kg_m3 where its water is named; nullptr: it is not.
  const LayeredWater* layers = nullptr;

  // The pressure at that depth in still water: the air's and the weight of all water above.
  double pressure_pa(double depth_m) const;
  // The mean of one over the speed of sound between two depths, s/m; of a scene that does not name
  // its water the one that an instrument takes.
  double slowness_s_m(double from_depth_m, double to_depth_m, double taken_m_s) const {
    return layers ? layers->mean_slowness_s_m(from_depth_m, to_depth_m) : 1.0 / taken_m_s;
  }
};

struct PressureSensor {
  Mount mount;
  double rate_hz = 20.0;
  Noise noise;                 // Pa
  double resolution_pa = 0.0;  // 0: none
  // The sensor's settings, by which it converts the pressure to a depth. They need not be those of
  // the water it is in: a sensor set for the sea reads 2.4 % too little in a lake.
  // The pressure at depth 0, as the sensor was zeroed; empty: the air over the water.
  std::optional<double> surface_pa;
  double water_kg_m3 = 1025.0, gravity_m_s2 = 9.82;
};
struct PressureReading {
  double pressure_pa = 0.0;
  double depth_m = 0.0;  // of the sensor, that the pressure stands for
  static void fields(auto&& field, auto& self) {
    field("pressure_pa", self.pressure_pa);
    field("depth_m", self.depth_m);
  }
};
PressureReading read_pressure(const PressureSensor& sensor, const SensorWater& water,
                              const State& state, const NoiseSource& noise, std::uint64_t sample);

struct Compass {
  double rate_hz = 50.0;
  Noise noise;                   // rad
  double declination_rad = 0.0;  // of magnetic north, positive east
  // Error of first harmonic, as hard iron makes: amplitude sin(heading - phase).
  double deviation_rad = 0.0, deviation_phase_rad = 0.0;
};
// Magnetic heading in [0, 2 pi), tilt compensated.
double read_compass(const Compass& compass, const State& state, const NoiseSource& noise,
                    std::uint64_t sample);

}  // namespace neritic::rov
