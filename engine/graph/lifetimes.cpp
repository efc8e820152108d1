// Fourth stage: from which to which position of the order a resource holds something. An output
// lives to the end of the frame. Pure; any thread.
#include "engine/graph/plan.hpp"

namespace neritic::graph {

std::vector<Lifetime> lifetimes(const GraphDecl& graph, std::span<const std::uint32_t> order) {
  std::vector<Lifetime> result(graph.resources.size());
  for (std::uint32_t position = 0; position < order.size(); ++position) {
    for (const Use& use : graph.passes[order[position]].uses) {
      Lifetime& life = result[use.resource];
      if (!life.used()) life.first = position;
      life.last = position;
    }
  }
  for (const Use& output : graph.outputs) {
    Lifetime& life = result[output.resource];
    if (life.used()) life.last = static_cast<std::uint32_t>(order.size()) - 1;
  }
  return result;
}

}  // namespace neritic::graph
