// A run's state as bytes, to go on later or in another process with the same hashes:
//
//   all little-endian, nothing aligned
//   8 bytes "NRTCSAVE"   u32 version   u32 sources
//   u64 scene hash (scene_hash.hpp)    u64 seed
//   u64 layout hash: names, types and counts of all fields
//   u64 step   f64 time_s   u64 bytes of state   u64 bytes of inputs
//   the state's block, the inputs' block, each source's name (u8 length, printable ASCII)
//   u64 hash of all bytes before
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
  // By SourceId, as the inbox knew them: state and inputs name sources by number.
  std::vector<std::string> sources;
};

// The format that a saved state must fit: PhysicsWorld::state_format().
struct StateFormat {
  std::uint64_t scene_hash = 0, seed = 0;
  double step_s = 0.0;
  PhysicsState state;  // any content
  PhysicsInputs inputs;
  std::vector<std::string> sources;  // "simulation", then those that the scene names
  std::uint64_t layout_hash() const;
};

std::vector<std::byte> encode_state(const StateFormat& format, const SavedState& saved);
// Everything in what is returned is finite and fits the format; the names begin with the format's,
// and none comes twice. name stands in messages.
Result<SavedState> parse_state(const StateFormat& format, std::span<const std::byte> bytes,
                               const std::string& name);

Status write_state(const std::filesystem::path& path, const StateFormat& format,
                   const SavedState& saved);
Result<SavedState> read_state(const std::filesystem::path& path, const StateFormat& format);

// The state of a simulation of the world that the format is of, to save after a step.
SavedState saved_state(const PhysicsSimulation& simulation, const StateFormat& format);
// The numbers of its sources in an inbox, by their numbers in the state. Opens those that the inbox
// does not know; kBadInput if it has no room for them.
Result<std::vector<SourceId>> open_sources(SampleInbox& inbox, const SavedState& saved);
// Goes on from it in a simulation of such a world, whose inbox has its sources under these numbers.
// Samples of any source may begin anew.
void restore_state(PhysicsSimulation& simulation, const SavedState& saved,
                   std::span<const SourceId> sources);
// The same in one that no device was opened in: each source has its number again.
void restore_state(PhysicsSimulation& simulation, const SavedState& saved);

}  // namespace neritic::testbed
