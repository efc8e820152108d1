// Second stage: which passes are needed. Walks from outputs and side effects back to writers; a
// write keeps what the version before held, so it needs that version's writer too. Pure; any
// thread.
#include "engine/graph/plan.hpp"
#include "engine/graph/versions.hpp"

namespace neritic::graph {

std::vector<bool> cull(const GraphDecl& graph) {
  const Versions versions(graph);
  std::vector<bool> kept(graph.passes.size(), false);
  std::vector<std::uint32_t> open;
  const auto keep = [&](std::uint32_t pass) {
    if (pass == kNoPass || kept[pass]) return;
    kept[pass] = true;
    open.push_back(pass);
  };
  for (const Use& output : graph.outputs) keep(versions.writer(output.resource, output.version));
  for (std::uint32_t p = 0; p < graph.passes.size(); ++p)
    if (graph.passes[p].side_effect) keep(p);
  while (!open.empty()) {
    const std::uint32_t pass = open.back();
    open.pop_back();
    for (const Use& use : graph.passes[pass].uses) keep(versions.writer(use.resource, use.version));
  }
  return kept;
}

}  // namespace neritic::graph
