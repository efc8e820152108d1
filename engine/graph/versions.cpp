// See versions.hpp: a flat table of writers, so that a lookup is one addition.
#include "engine/graph/versions.hpp"

#include "engine/graph/access.hpp"

namespace neritic::graph {

Versions::Versions(const GraphDecl& graph) : first_(graph.resources.size() + 1, 0) {
  // Count the writes of each resource, turn counts into starts, then fill.
  for (const PassDecl& pass : graph.passes)
    for (const Use& use : pass.uses)
      if (access_info(use.access).write) ++first_[use.resource + 1];
  for (std::size_t r = 1; r < first_.size(); ++r) first_[r] += first_[r - 1];
  writers_.resize(first_.back());
  for (std::uint32_t p = 0; p < graph.passes.size(); ++p) {
    for (const Use& use : graph.passes[p].uses) {
      if (!access_info(use.access).write) continue;
      const std::uint32_t slot = first_[use.resource] + use.version;
      if (slot < first_[use.resource + 1]) writers_[slot] = {p, range_of(graph, use)};
    }
  }
}

}  // namespace neritic::graph
