// Bounds of what a person gives. Any thread.
#pragma once

#include <initializer_list>

#include "engine/core/result.hpp"

namespace neritic::diver {

struct Limit {
  const char* name;  // as the error says it
  double value, low, high;
};
// An error of the first value that is outside, or no number: what was found, what is accepted.
inline Status check_limits(std::initializer_list<Limit> limits) {
  for (const Limit& l : limits)
    if (!(l.value >= l.low && l.value <= l.high))
      return bad_input("{}: {} found, {} to {} is accepted", l.name, l.value, l.low, l.high);
  return {};
}

}  // namespace neritic::diver
