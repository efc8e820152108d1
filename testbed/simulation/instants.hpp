// The instants of a rate, as shares of a physics step: a vehicle's step ends a part at each, so
// that control acts and sensors sample at their own times, whatever the rate of the physics. Plain
// values; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace neritic::testbed {

// Part of a step, by shares of it from 0 to 1.
struct StepPart {
  double from = 0.0, to = 1.0;
};

class Instants {
 public:
  // Preconditions: rate_hz > 0, step_s > 0. The first instant is at time 0.
  Instants(double rate_hz, double step_s) : steps_(1.0 / (rate_hz * step_s)) {}

  // Whether one lies at this share of the step, which is 0 or was given by next().
  bool at(std::uint64_t step, double share) const;
  // The first after this share of the step; 1: none before its end.
  double next(std::uint64_t step, double share) const;

 private:
  double share_of(double index, std::uint64_t step) const;
  double steps_;  // in a period
};

// The first of all.
double next_of(std::span<const Instants> all, std::uint64_t step, double share);

}  // namespace neritic::testbed
