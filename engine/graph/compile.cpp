// All stages in turn: a declaration becomes a plan. Pure; any thread.
#include "engine/core/check.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {

Result<Plan> compile(GraphDecl graph, std::span<const MemoryNeed> needs) {
  NERITIC_CHECK(needs.size() == graph.resources.size(), "{} needs for {} resources", needs.size(),
                graph.resources.size());
  NERITIC_TRY_STATUS(validate(graph));
  gather_usage(graph);
  Plan plan;
  plan.graph = std::move(graph);
  plan.needs.assign(needs.begin(), needs.end());
  plan.kept = cull(plan.graph);
  plan.order = order(plan.graph, plan.kept);
  plan.lifetimes = lifetimes(plan.graph, plan.order);
  plan.placement = place(plan.graph, plan.lifetimes, plan.needs);
  plan.barriers = barriers(plan.graph, plan.order, plan.lifetimes, plan.needs, plan.placement);
  return plan;
}

}  // namespace neritic::graph
