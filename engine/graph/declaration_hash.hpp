// Inside engine/graph: a number for a declaration, to find its plan. Pure; any thread.
#pragma once

#include <cstdint>

#include "engine/graph/plan.hpp"

namespace neritic::graph {

// Equal declarations have equal hashes; the cache also compares with ==, in case of a collision.
std::uint64_t hash_of(const GraphDecl& graph);

}  // namespace neritic::graph
