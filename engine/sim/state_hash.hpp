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

// A block (block.hpp) starts with its counts. A state may list counts and fields for its hash alone
// (hashed_counts, hashed_fields), to leave out what is not in use.
template <class State>
void add_state(Hash64& hash, const State& state) {
  if constexpr (requires { state.hashed_counts(); })
    for (const std::uint64_t count : state.hashed_counts()) hash.add(count);
  else if constexpr (requires { state.counts(); })
    for (const std::uint64_t count : state.counts()) hash.add(count);
  const auto add = [&](const auto& scalar) { hash.add(canonical_bits(scalar)); };
  const auto field = [&](const auto&, const auto& piece) { for_each_scalar(piece, add); };
  if constexpr (requires { State::hashed_fields(field, state); })
    State::hashed_fields(field, state);
  else
    for_each_scalar(state, add);
}

// The hash of values alone.
template <class State>
std::uint64_t state_hash(const State& state) {
  Hash64 hash;
  add_state(hash, state);
  return hash.value();
}

// The hash of a state after a number of steps: two runs compare it.
template <class State>
std::uint64_t state_hash(std::uint64_t step, const State& state) {
  Hash64 hash;
  hash.add(step);
  add_state(hash, state);
  return hash.value();
}

}  // namespace neritic::sim
