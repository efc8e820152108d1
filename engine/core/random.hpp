// Counter-based random numbers: the value depends only on (seed, stream, frame, index), so that any
// order and any number of threads give the same. SplitMix64's finalizer (Steele, Lea, Flood 2014)
// chained over the four words. Any thread.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace neritic {

struct RandomKey {
  std::uint64_t seed = 0, stream = 0, frame = 0;
};

inline std::uint64_t mix64(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}
// The words of a key mixed once, for a caller that draws many numbers by it.
struct MixedKey {
  explicit MixedKey(const RandomKey& key)
      : bits(mix64(key.frame ^ mix64(key.stream ^ mix64(key.seed)))) {}
  std::uint64_t bits;
};
inline std::uint64_t random_bits(const MixedKey& key, std::uint64_t index) {
  return mix64(index ^ key.bits);
}
inline std::uint64_t random_bits(const RandomKey& key, std::uint64_t index) {
  return random_bits(MixedKey(key), index);
}
// Uniform in [0, 1), 53 bits.
inline double random_uniform(const MixedKey& key, std::uint64_t index) {
  return static_cast<double>(random_bits(key, index) >> 11) * 0x1.0p-53;
}
inline double random_uniform(const RandomKey& key, std::uint64_t index) {
  return random_uniform(MixedKey(key), index);
}
// A normal number of two uniform ones in [0, 1) (Box and Muller 1958).
inline double normal_of(double u, double v) {
  return std::sqrt(-2.0 * std::log(1.0 - u)) * std::cos(2.0 * std::numbers::pi * v);
}
// A normal number of the uniform ones of indices 2 index and 2 index + 1.
inline double random_normal(const MixedKey& key, std::uint64_t index) {
  return normal_of(random_uniform(key, 2 * index), random_uniform(key, 2 * index + 1));
}
inline double random_normal(const RandomKey& key, std::uint64_t index) {
  return random_normal(MixedKey(key), index);
}

}  // namespace neritic
