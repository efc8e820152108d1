// Whether four numbers that enter are a rotation: the one tolerance of all that checks them. Pure
// function; any thread.
#pragma once

#include <cmath>

#include "engine/core/math.hpp"

namespace neritic::testbed {

// How far the squared length may be off 1: 32-bit floats, and senders that round to three digits.
inline constexpr double kUnitWithin = 2e-3;

inline bool is_unit_rotation(const Quat& q) {
  return std::abs(glm::dot(q, q) - 1.0) <= kUnitWithin;
}

}  // namespace neritic::testbed
