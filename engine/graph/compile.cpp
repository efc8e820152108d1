// All stages in turn: a declaration becomes a plan. Pure; any thread.
#include "engine/core/check.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {

namespace {

Status check_sizes(const Plan& plan) {
  for (std::size_t r = 0; r < plan.needs.size(); ++r) {
    const ResourceDecl& resource = plan.graph.resources[r];
    const MemoryNeed& need = plan.needs[r];
    if (!resource.imported && plan.lifetimes[r].used() && need.block_bytes > 0 &&
        need.size > need.block_bytes)
      return failure(ErrorCode::kOutOfMemory,
                     "{} takes {} bytes, the device gives at most {} in one piece", resource.name,
                     need.size, need.block_bytes);
  }
  return {};
}

}  // namespace

Result<Plan> compile(GraphDecl graph, const NeedsOf& needs_of) {
  NERITIC_TRY_STATUS(validate(graph));
  gather_usage(graph);
  Plan plan;
  plan.graph = std::move(graph);
  plan.needs = needs_of(plan.graph);
  NERITIC_CHECK(plan.needs.size() == plan.graph.resources.size(), "{} needs for {} resources",
                plan.needs.size(), plan.graph.resources.size());
  plan.kept = cull(plan.graph);
  plan.order = order(plan.graph, plan.kept);
  plan.lifetimes = lifetimes(plan.graph, plan.order);
  NERITIC_TRY_STATUS(check_sizes(plan));
  plan.placement = place(plan.graph, plan.lifetimes, plan.needs);
  plan.barriers = barriers(plan.graph, plan.order, plan.lifetimes, plan.needs, plan.placement);
  return plan;
}

}  // namespace neritic::graph
