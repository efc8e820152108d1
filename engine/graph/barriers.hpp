// Inside engine/graph: what stages share that make barriers. Pure; any thread.
#pragma once

#include <vector>

#include "engine/graph/epochs.hpp"

namespace neritic::graph {

// Waits for all of `before` and serves all of `after`, on the part.
Barrier barrier_between(const Part& part, const Epoch& before, const Epoch& after);

// Makes one barrier of those on neighbouring mips and layers of a resource that do the same. The
// list must have the parts of a resource in order of mips, then layers.
void merge_parts(std::vector<Barrier>& list);

}  // namespace neritic::graph
