// All stages in turn: a declaration becomes a plan. Pure; any thread.
#include <algorithm>
#include <numeric>

#include "engine/core/check.hpp"
#include "engine/graph/past.hpp"

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

// Content that the next frame reads is written as a whole, or not at all.
Status check_histories(const Plan& plan) {
  const auto written = [](const Part& part) {
    return std::any_of(part.epochs.begin(), part.epochs.end(),
                       [](const Epoch& epoch) { return epoch.write; });
  };
  std::vector<bool> some(plan.graph.resources.size()), none(plan.graph.resources.size());
  for (const Part& part : plan.parts) (written(part) ? some : none)[part.resource] = true;
  for (std::size_t r = 0; r < some.size(); ++r)
    if (plan.graph.resources[r].history == History::kNext && some[r] && none[r])
      return failure(ErrorCode::kInternal, "frame graph: \"{}\" is written only in part",
                     plan.graph.resources[r].name);
  return {};
}

void start_from_nothing(Plan& plan) {
  std::vector<std::uint64_t> objects(plan.graph.resources.size());
  std::iota(objects.begin(), objects.end(), 0);
  std::vector<std::uint64_t> classes(plan.placement.heap_size.size());
  std::iota(classes.begin(), classes.end(), 0);
  Past().run(plan, objects, classes, plan.barriers.first);
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
  plan.parts = find_parts(plan.graph, plan.order);
  NERITIC_TRY_STATUS(check_histories(plan));
  plan.left = left_pending(plan.graph, plan.parts);
  plan.takeover = taken_over(plan.graph, plan.lifetimes, plan.needs, plan.placement, plan.left);
  plan.barriers = barriers(plan.graph, plan.order, plan.parts);
  start_from_nothing(plan);
  return plan;
}

}  // namespace neritic::graph
