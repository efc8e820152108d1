// Inside engine/graph: a number for a declaration, to find its plan. Pure; any thread.
#pragma once

#include <cstdint>

#include "engine/graph/plan.hpp"

namespace neritic::graph {

// Equal declarations hash equal; the cache tells unequal ones with one hash apart by ==.
std::uint64_t hash_of(const GraphDecl& graph);

}  // namespace neritic::graph
