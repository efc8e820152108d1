// Hash of a state's numbers in canonical form: -0 counts as 0, every NaN as one, padding not at
// all. Equal states have equal hashes on every machine of the same arithmetic. Pure; any thread.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "engine/core/hash.hpp"
#include "engine/sim/fields.hpp"

namespace neritic::sim {

// Every number as one 64-bit word: floats widen exactly, integers keep their value.
template <Scalar T>
std::uint64_t canonical_bits(T value) {
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(value))
      return std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN());
    return std::bit_cast<std::uint64_t>(value == T{0} ? 0.0 : static_cast<double>(value));
  } else {
    return static_cast<std::uint64_t>(value);
  }
}

template <class State>
std::uint64_t state_hash(const State& state) {
  Hash64 hash;
  for_each_scalar_in_use(state, [&](const auto& scalar) { hash.add(canonical_bits(scalar)); });
  return hash.value();
}

}  // namespace neritic::sim
