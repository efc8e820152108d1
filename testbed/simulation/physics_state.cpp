#include "testbed/simulation/physics_state.hpp"

namespace neritic::sim {

using testbed::PhysicsState;

template void add_state(Hash64& hash, const PhysicsState& state);
template std::uint64_t state_hash(const PhysicsState& state);
template std::uint64_t state_hash(std::uint64_t step, const PhysicsState& state);
template bool all_finite(const PhysicsState& state);
template void check_fields_cover(const PhysicsState& state);
template class SnapshotSource<PhysicsState>;
template class SnapshotReader<PhysicsState>;
template class Simulation<PhysicsState, testbed::PhysicsInputs, testbed::SampleInbox>;

}  // namespace neritic::sim
