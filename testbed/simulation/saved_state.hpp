// A run's state as bytes, to go on later or in another process with the same hashes:
//
//   all little-endian, nothing aligned
//   8 bytes "NRTCSAVE"   u32 version   u32 0
//   u64 scene hash (scene_hash.hpp)    u64 layout hash: names, types and counts of all fields
//   u64 step   f64 time_s   u64 bytes of state   u64 bytes of inputs
//   the state's block, the inputs' block, u64 hash of all bytes before
//
// Pure functions; any thread.
#pragma once

#include <filesystem>

#include "testbed/simulation/physics_state.hpp"

namespace neritic::testbed {

struct SavedState {
  std::uint64_t step = 0;
  PhysicsState state;
  PhysicsInputs inputs;  // that hold until a message changes them
};

// What a saved state must fit: PhysicsWorld::state_format().
struct StateFormat {
  std::uint64_t scene_hash = 0;
  double step_s = 0.0;
  PhysicsState state;  // any content
  PhysicsInputs inputs;
  std::uint64_t layout_hash() const;
};

std::vector<std::byte> encode_state(const StateFormat& format, const SavedState& saved);
// Everything in what is returned is finite and fits the format. name stands in messages.
Result<SavedState> parse_state(const StateFormat& format, std::span<const std::byte> bytes,
                               const std::string& name);

Status write_state(const std::filesystem::path& path, const StateFormat& format,
                   const SavedState& saved);
Result<SavedState> read_state(const std::filesystem::path& path, const StateFormat& format);

}  // namespace neritic::testbed
