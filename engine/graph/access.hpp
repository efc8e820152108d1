// Inside engine/graph: rules about accesses that the stages share. See plan.hpp for the accesses.
// Pure functions on plain data; any thread.
#pragma once

#include "engine/graph/plan.hpp"

namespace neritic::graph {

// Whether a resource of that kind can be used so at all (no image is a vertex buffer).
bool access_fits(Access access, ResourceKind kind);
// Accesses that happen after the frame: no pass can declare them.
bool only_as_output(Access access);
// Whether a pass may read by `read` the very resource that it writes by `write`: the write's
// stages, access and layout include the read's.
bool subsumes(Access write, Access read);

// The mips and layers of a use, with concrete counts. The resource index must be valid.
ImageRange range_of(const GraphDecl& graph, const Use& use);
// Whether both touch a common part of one resource.
bool uses_meet(const GraphDecl& graph, const Use& a, const Use& b);

}  // namespace neritic::graph
