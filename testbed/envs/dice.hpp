// Random numbers of one environment at one of its steps: counter-based, so that they depend on
// seed, episode, step and place alone. Plain value; any thread.
#pragma once

#include <numbers>

#include "engine/core/random.hpp"

namespace neritic::testbed {

class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t episode, std::uint64_t step)
      : base_(mix64(((episode << 32) + step) ^ mix64(mix64(seed)))) {}
  std::uint64_t bits(std::uint64_t place) const { return mix64(place ^ base_); }
  // In [0, 1).
  double share(std::uint64_t place) const {
    return static_cast<double>(bits(place) >> 11) * 0x1.0p-53;
  }
  double between(std::uint64_t place, double least, double most) const {
    return least + (most - least) * share(place);
  }
  // Around 1, up to `by` either way.
  double factor(std::uint64_t place, double by) const { return between(place, 1.0 - by, 1.0 + by); }
  // For mean 0 and deviation 1: the sum of four even shares, which ends at 3.46 deviations
  // (Irwin-Hall). A tenth of the time of Box and Muller's.
  double normal(std::uint64_t place) const {
    const std::uint64_t b = bits(place);
    const auto sum = (b & 0xffff) + (b >> 16 & 0xffff) + (b >> 32 & 0xffff) + (b >> 48);
    // Each share's steps lie in their middle: (sum + 4 / 2) / 2^16 has the mean 2.
    return (static_cast<double>(sum + 2) * 0x1.0p-16 - 2.0) * std::numbers::sqrt3;
  }

 private:
  std::uint64_t base_;
};

}  // namespace neritic::testbed
