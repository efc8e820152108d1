// How often a vehicle is stepped for the error that a user accepts: measured by `neritic tradeoff
// physics`, a BlueROV2 Heavy that flies 20 s round a square in a current, with and without the lag
// of its thrusters. Pure function; any thread.
#pragma once

#include <span>

#include "engine/core/result.hpp"

namespace neritic::rov {

struct MeasuredRate {
  double hz;           // of kGuarded, which stays stable where plain RK4 would not
  double error_m;      // the largest distance from the true path, with and without lag
  double us_a_second;  // of one core (two shared Xeon cores), lag included
};
// From the cheapest to the best. Below 80 Hz the guard takes as many substeps and nothing is saved.
std::span<const MeasuredRate> measured_rates();

// The cheapest that holds the error. kBadInput where none does.
Result<MeasuredRate> cheapest_rate(double max_error_m);

}  // namespace neritic::rov
