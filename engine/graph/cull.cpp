// Second stage: which passes are needed. Walks from outputs and side effects back to writers; a
// write keeps what the version before held, so it needs the earlier writers of its part too. Pure;
// any thread.
#include "engine/graph/access.hpp"
#include "engine/graph/plan.hpp"
#include "engine/graph/versions.hpp"

namespace neritic::graph {

std::vector<bool> cull(const GraphDecl& graph) {
  const Versions versions(graph);
  std::vector<bool> kept(graph.passes.size(), false);
  std::vector<std::uint32_t> open;
  const auto keep = [&](std::uint32_t pass) {
    if (kept[pass]) return;
    kept[pass] = true;
    open.push_back(pass);
  };
  const auto keep_makers = [&](const Use& use) {
    versions.visit_makers(use, range_of(graph, use), keep);
  };
  for (const Use& output : graph.outputs) keep_makers(output);
  for (std::uint32_t p = 0; p < graph.passes.size(); ++p)
    if (graph.passes[p].side_effect) keep(p);
  while (!open.empty()) {
    const std::uint32_t pass = open.back();
    open.pop_back();
    for (const Use& use : graph.passes[pass].uses) keep_makers(use);
  }
  return kept;
}

}  // namespace neritic::graph
