// Sensors that hear: Doppler velocity log (DVL), altimeter, acoustic positioning (USBL). World axes
// north, east, down; body axes forward, starboard, down. Pure functions; any thread.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "rov/inertial_sensors.hpp"

namespace neritic::rov {

// The distance to the first thing along a ray, up to most_m; infinity where there is none.
struct RayQuery {
  double (*cast)(const void* context, const Vec3& origin_ned_m, const Vec3& direction_ned,
                 double most_m) = nullptr;
  const void* context = nullptr;
};

// Four beams, 90 degrees apart, each leaning outwards from the mount's down axis.
struct Dvl {
  Mount mount;
  double rate_hz = 10.0;
  double lean_rad = 0.3926990816987241;        // 22.5 degrees
  double first_beam_rad = 0.7853981633974483;  // from forward: 45 degrees
  double least_m = 0.05, most_m = 50.0;
  Noise noise;               // of each beam's speed, m/s
  double noise_share = 0.0;  // white noise on top, a share of the beam's speed
  Noise range_noise;         // m
  // The speed of sound by which it converts frequency shifts and travel times, as its user sets it;
  // empty: it measures the one around it, and errs by neither (1500 m/s in a scene that does not
  // name its water).
  std::optional<double> sound_m_s;
};
struct DvlReading {
  std::array<double, 4> range_m{};    // along each beam; 0 where it heard nothing
  std::array<double, 4> speed_m_s{};  // of the sensor along each beam
  Vec3 velocity_m_s{0.0};             // sensor axes, least squares of the beams heard
  double altitude_m = 0.0;            // mean of the beams' vertical reach below the sensor
  double sound_m_s = 0.0;             // by which it converted
  std::uint64_t heard = 0;            // bit i: beam i
  bool hears(std::size_t beam) const { return heard >> beam & 1u; }
  // Below three beams there is no velocity.
  bool locked() const { return std::popcount(heard) >= 3; }
  static void fields(auto&& field, auto& self) {
    field("range_m", self.range_m);
    field("speed_m_s", self.speed_m_s);
    field("velocity_m_s", self.velocity_m_s);
    field("altitude_m", self.altitude_m);
    field("sound_m_s", self.sound_m_s);
    field("heard", self.heard);
  }
};
// In water of another speed of sound than it is set to: its speeds are too large or small by the
// ratio of the set one to the one at the transducer, its ranges by that to the mean on their way.
DvlReading read_dvl(const Dvl& dvl, const SensorWater& water, const State& state,
                    const RayQuery& rays, const NoiseSource& noise, std::uint64_t sample);
// Beam i as a unit vector, sensor axes.
Vec3 dvl_beam(const Dvl& dvl, std::size_t i);

struct Altimeter {
  Mount mount;  // looks along its down axis
  double rate_hz = 10.0;
  double least_m = 0.3, most_m = 100.0;
  Noise noise;                      // m
  double noise_share = 0.0;         // white noise on top, a share of the distance
  std::optional<double> sound_m_s;  // by which it converts travel times; empty: it measures it
};
struct AltimeterReading {
  double distance_m = 0.0;  // along its axis
  std::uint64_t heard = 0;  // 0 or 1
  static void fields(auto&& field, auto& self) {
    field("distance_m", self.distance_m);
    field("heard", self.heard);
  }
};
AltimeterReading read_altimeter(const Altimeter& altimeter, const SensorWater& water,
                                const State& state, const RayQuery& rays, const NoiseSource& noise,
                                std::uint64_t sample);

// A transceiver at a fixed place asks a beacon on the vehicle: range by travel time, direction by
// phase over its short baseline.
struct Usbl {
  Vec3 transceiver_ned_m{0.0};
  Vec3 beacon_m{0.0};  // on the body
  double rate_hz = 1.0;
  double sound_m_s = 1500.0;  // by which it converts travel time into range, as its user sets it
  double most_m = 1000.0;
  Noise range_noise;        // m
  Noise direction_noise;    // rad, across the line of sight, both ways
  double lost_share = 0.0;  // of the answers
};
struct UsblReading {
  std::uint64_t heard = 0;     // 0 or 1
  double range_m = 0.0;        // half the travel time, times sound_m_s
  double bearing_rad = 0.0;    // from north to east
  double elevation_rad = 0.0;  // positive down
  Vec3 position_ned_m{0.0};    // what they put together to
  // Two-way travel time, along a straight line through the scene's water. A real answer would show
  // the vehicle half of it ago; this reading is of its state now, and the user adds the delay.
  double travel_s = 0.0;
  static void fields(auto&& field, auto& self) {
    field("heard", self.heard);
    field("range_m", self.range_m);
    field("bearing_rad", self.bearing_rad);
    field("elevation_rad", self.elevation_rad);
    field("position_ned_m", self.position_ned_m);
    field("travel_s", self.travel_s);
  }
};
UsblReading read_usbl(const Usbl& usbl, const SensorWater& water, const State& state,
                      const NoiseSource& noise, std::uint64_t sample);

}  // namespace neritic::rov
