// Errors of sensors: white noise, a bias that differs each time the device is switched on, and a
// random walk of that bias. All are functions of a seed and the sample's number alone, so that
// samples may be asked for in any order, on any thread, and again. Off where all are 0. Any thread.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/core/math.hpp"
#include "engine/core/random.hpp"

namespace neritic::rov {

// Standard deviations in the quantity's unit.
struct Noise {
  double white = 0.0;  // a sample
  double bias = 0.0;   // constant over a dive
  double walk = 0.0;   // after one second; grows with the root of time
  bool off() const { return white == 0.0 && bias == 0.0 && walk == 0.0; }
};

// White noise as data sheets give it: a density per root hertz, over the sensor's band.
inline double white_from_density(double density_per_root_hz, double rate_hz) {
  return density_per_root_hz * std::sqrt(rate_hz);
}

// The value after `steps` steps of a random walk with normal steps of variance 1, in about 2 log2
// (steps) draws: first from power of two to power of two, then by Brownian bridges between (Lévy
// 1948). walk(k + 1) - walk(k) are independent, whatever order they are asked in.
double random_walk(const RandomKey& key, std::uint64_t steps);

// Noise of one sensor of one vehicle.
struct NoiseSource {
  std::uint64_t seed = 0;    // the scene's
  std::uint64_t stream = 0;  // vehicle and sensor
  // The error of one component of sample k.
  double error(const Noise& noise, std::uint64_t component, std::uint64_t sample,
               double rate_hz) const;
  Vec3 error3(const Noise& noise, std::uint64_t first_component, std::uint64_t sample,
              double rate_hz) const;
  // Uniform in [0, 1).
  double uniform(std::uint64_t component, std::uint64_t sample) const;
};

// The number of the last sample due in (from_s, to_s] of a sensor that samples at 0, 1 / rate, ...;
// nothing if none is due. If several are due, those before the last are dropped.
std::optional<std::uint64_t> sample_due(double rate_hz, double from_s, double to_s);

}  // namespace neritic::rov
