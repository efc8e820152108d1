// Checks parameters that a person writes against their bounds. Any thread.
#pragma once

#include <initializer_list>

#include "engine/core/refusal.hpp"
#include "engine/core/result.hpp"

namespace neritic::diver {

struct Bounds {
  double low, high;
};
struct Limit {
  const char* name;  // as the error says it
  double value;
  Bounds in;
};
// An error of the first value that is outside, or no number: what was found, what is accepted.
inline Status check_limits(std::initializer_list<Limit> limits) {
  for (const Limit& l : limits)
    if (!(l.value >= l.in.low && l.value <= l.in.high))
      return refusal(l.name, fmt::format("{}", l.value),
                     fmt::format("{} to {}", l.in.low, l.in.high));
  return {};
}

}  // namespace neritic::diver
