#include "rov/sensor_noise.hpp"

#include <bit>
#include <cmath>

namespace neritic::rov {
namespace {

// Numbers of a component's draws: kinds of error, each with indices of its own.
enum Draw : std::uint64_t { kWhite = 0, kBias = 1, kWalk = 2, kUniform = 3 };

RandomKey key_of(const NoiseSource& source, std::uint64_t component, Draw draw) {
  return {source.seed, source.stream, 8 * component + draw};
}

}  // namespace

double random_walk(const RandomKey& key, std::uint64_t steps) {
  if (steps == 0) return 0.0;
  const MixedKey mixed(key);
  const auto normal = [&mixed](std::uint64_t n) { return random_normal(mixed, n); };
  // Draw n is the walk's own at step n: an increment up to it, or the bridge's deviation there.
  double low_value = 0.0, high_value = normal(1);
  std::uint64_t low = 0, high = 1;
  while (high < steps) {
    low = high;
    low_value = high_value;
    high *= 2;
    high_value += std::sqrt(static_cast<double>(high - low)) * normal(high);
  }
  while (high != steps) {
    const std::uint64_t middle = low + (high - low) / 2;
    const double deviation = 0.5 * std::sqrt(static_cast<double>(high - low));
    const double value = 0.5 * (low_value + high_value) + deviation * normal(middle);
    (middle < steps ? low : high) = middle;
    (middle < steps ? low_value : high_value) = value;
  }
  return high_value;
}

double NoiseSource::error(const Noise& noise, std::uint64_t component, std::uint64_t sample,
                          double rate_hz) const {
  double sum = 0.0;
  if (noise.white != 0.0)
    sum += noise.white * random_normal(key_of(*this, component, kWhite), sample);
  if (noise.bias != 0.0) sum += noise.bias * random_normal(key_of(*this, component, kBias), 0);
  if (noise.walk != 0.0)
    sum += noise.walk / std::sqrt(rate_hz) * random_walk(key_of(*this, component, kWalk), sample);
  return sum;
}

Vec3 NoiseSource::error3(const Noise& noise, std::uint64_t first, std::uint64_t sample,
                         double rate_hz) const {
  if (noise.off()) return Vec3(0.0);
  return {error(noise, first, sample, rate_hz), error(noise, first + 1, sample, rate_hz),
          error(noise, first + 2, sample, rate_hz)};
}

double NoiseSource::uniform(std::uint64_t component, std::uint64_t sample) const {
  return random_uniform(key_of(*this, component, kUniform), sample);
}

std::optional<std::uint64_t> sample_due(double rate_hz, double from_s, double to_s) {
  // A sample on the boundary belongs to the step that ends there, within rounding of the times.
  const double last = std::floor(to_s * rate_hz + 1e-5),
               before = std::floor(from_s * rate_hz + 1e-5);
  if (!(last > before) || !(last >= 0.0)) return std::nullopt;
  return static_cast<std::uint64_t>(last);
}

}  // namespace neritic::rov
