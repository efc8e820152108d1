#include "testbed/simulation/instants.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::testbed {
namespace {

// Shares are multiples of 2^-26 of a step, 0.06 ns at 240 Hz: more than the times of a day's steps
// round by, so that the same instant has the same share wherever it is computed.
constexpr double kShares = 67108864.0;

}  // namespace

// The share of the instant of that number. Those that are a share off a step's start or end lie on
// it.
double Instants::share_of(double index, std::uint64_t step) const {
  const double shares = std::round((index * steps_ - static_cast<double>(step)) * kShares);
  if (std::abs(shares) <= 1.0) return 0.0;
  if (std::abs(shares - kShares) <= 1.0) return 1.0;
  return shares / kShares;
}

bool Instants::at(std::uint64_t step, double share) const {
  return share_of(std::round((static_cast<double>(step) + share) / steps_), step) == share;
}

double Instants::next(std::uint64_t step, double share) const {
  double index = std::floor((static_cast<double>(step) + share) / steps_), at = share;
  for (; at <= share; ++index) at = share_of(index, step);
  return std::min(at, 1.0);
}

double next_of(std::span<const Instants> all, std::uint64_t step, double share) {
  double first = 1.0;
  for (const Instants& one : all) first = std::min(first, one.next(step, share));
  return first;
}

}  // namespace neritic::testbed
