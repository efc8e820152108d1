// Third stage: an order of the kept passes in which every read comes after its writer and before
// the next pass that writes over it. Kahn's algorithm (1962); among the passes that are free the
// one declared first goes first. Pure; any thread.
#include <algorithm>
#include <functional>
#include <queue>

#include "engine/core/check.hpp"
#include "engine/graph/access.hpp"
#include "engine/graph/plan.hpp"
#include "engine/graph/versions.hpp"

namespace neritic::graph {
namespace {

struct Edge {
  std::uint32_t before, after;
  auto operator<=>(const Edge&) const = default;
};

// Read after write and write after write: the writers of what a use finds come first. Write after
// read: the writers that replace what a use reads come after it.
std::vector<Edge> dependencies(const GraphDecl& graph, const std::vector<bool>& kept) {
  const Versions versions(graph);
  std::vector<Edge> edges;
  const auto add = [&](std::uint32_t before, std::uint32_t after) {
    if (before != after && kept[before] && kept[after]) edges.push_back({before, after});
  };
  for (std::uint32_t p = 0; p < graph.passes.size(); ++p) {
    if (!kept[p]) continue;
    for (const Use& use : graph.passes[p].uses) {
      const ImageRange range = range_of(graph, use);
      versions.visit_makers(use, range, [&](std::uint32_t maker) { add(maker, p); });
      if (!access_info(use.access).write)
        versions.visit_replacers(use, range, [&](std::uint32_t replacer) { add(p, replacer); });
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

std::vector<std::uint32_t> order(const GraphDecl& graph, const std::vector<bool>& kept) {
  const std::vector<Edge> edges = dependencies(graph, kept);
  std::vector<std::uint32_t> waits_for(graph.passes.size(), 0);
  for (const Edge& edge : edges) ++waits_for[edge.after];

  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> ready;
  std::size_t wanted = 0;
  for (std::uint32_t p = 0; p < graph.passes.size(); ++p) {
    if (!kept[p]) continue;
    ++wanted;
    if (waits_for[p] == 0) ready.push(p);
  }
  std::vector<std::uint32_t> result;
  result.reserve(wanted);
  while (!ready.empty()) {
    const std::uint32_t pass = ready.top();
    ready.pop();
    result.push_back(pass);
    auto edge = std::lower_bound(edges.begin(), edges.end(), Edge{pass, 0});
    for (; edge != edges.end() && edge->before == pass; ++edge)
      if (--waits_for[edge->after] == 0) ready.push(edge->after);
  }
  // A valid graph has no cycle: declaration order satisfies every edge.
  NERITIC_CHECK(result.size() == wanted, "a cycle: {} of {} passes ordered", result.size(), wanted);
  return result;
}

}  // namespace neritic::graph
