// Inside engine/graph: finds the parts of all resources and their epochs (plan.hpp). Pure; any
// thread.
#pragma once

#include <span>
#include <vector>

#include "engine/graph/access.hpp"

namespace neritic::graph {

// The parts of all resources, those of one resource in a row. The graph must be valid.
std::vector<Part> find_parts(const GraphDecl& graph, std::span<const std::uint32_t> order);

}  // namespace neritic::graph
