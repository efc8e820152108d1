// Intervals of the numbers that a table of a vehicle's file has. Pure; any thread.
#pragma once

#include <span>

#include "engine/core/result.hpp"

namespace neritic::rov {

struct Bound {
  const char* name;
  double value, least, most;
};

// The error names "table.name", the first number that is not within its bounds, and these.
Status check_bounds(const char* table, std::span<const Bound> bounds);

}  // namespace neritic::rov
