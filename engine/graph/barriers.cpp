// Sixth stage: the barriers between the passes. A barrier stands before the first use of each epoch
// (epochs.hpp) of a part of a resource; it waits for the whole epoch before and serves the whole
// epoch after, so later reads of the same run need none. Those before first uses depend on what
// earlier runs left: past.cpp adds them when the plan runs. Pure; any thread.
//
// Why one step back is enough: an epoch's barrier waits for the stages of the epoch before, whose
// own barrier waited for the one before that (an execution dependency chain, Vulkan 1.3
// specification, section 7.1), and whatever was written was made available by the barrier right
// after it.
#include "engine/graph/barriers.hpp"

#include <algorithm>

namespace neritic::graph {
namespace {

// Grows a by b if both do the same to neighbouring mips or layers.
bool merged(Barrier& a, const Barrier& b) {
  Barrier same = b;
  same.range = a.range;
  if (!(same == a)) return false;
  ImageRange& r = a.range;
  if (r.mip == b.range.mip && r.mips == b.range.mips && r.layer + r.layers == b.range.layer) {
    r.layers += b.range.layers;
    return true;
  }
  if (r.layer == b.range.layer && r.layers == b.range.layers && r.mip + r.mips == b.range.mip) {
    r.mips += b.range.mips;
    return true;
  }
  return false;
}

}  // namespace

Barrier barrier_between(const Part& part, const Epoch& before, const Epoch& after) {
  Barrier barrier;
  barrier.resource = part.resource;
  barrier.range = part.range;
  barrier.src_stages = before.stages;
  barrier.src_access = before.written();
  barrier.dst_stages = after.stages;
  barrier.dst_access = after.access;
  barrier.old_layout = before.layout;
  barrier.new_layout = after.layout;
  return barrier;
}

void merge_parts(std::vector<Barrier>& list) {
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < list.size(); ++i)
      for (std::size_t j = i + 1; j < list.size(); ++j)
        if (list[i].resource == list[j].resource && merged(list[i], list[j])) {
          list.erase(list.begin() + static_cast<std::ptrdiff_t>(j--));
          again = true;
        }
  }
}

BarrierPlan barriers(const GraphDecl& graph, std::span<const std::uint32_t> order,
                     std::span<const Part> parts) {
  BarrierPlan plan;
  plan.first.resize(order.size() + 1);
  plan.before.resize(order.size() + 1);
  bool in_parts = false;
  for (const Part& part : parts) {
    in_parts |= !part.is_whole(graph.resources[part.resource]);
    for (std::size_t e = 1; e < part.epochs.size(); ++e)
      plan.before[part.epochs[e].position].push_back(
          barrier_between(part, part.epochs[e - 1], part.epochs[e]));
  }
  if (in_parts)
    for (std::vector<Barrier>& list : plan.before) merge_parts(list);
  return plan;
}

std::vector<Pending> left_pending(const GraphDecl& graph, std::span<const Part> parts) {
  std::vector<Pending> left(graph.resources.size());
  for (const Part& part : parts) {
    if (part.epochs.empty()) continue;
    left[part.resource].stages |= part.epochs.back().stages;
    left[part.resource].access |= part.epochs.back().written();
  }
  return left;
}

// Waiting for the last owner of the memory would do, since earlier ones are ordered through it; but
// the validation layer follows such a chain only through images that it takes for aliases of each
// other, and reports a hazard otherwise.
std::vector<Pending> taken_over(const GraphDecl& graph, std::span<const Lifetime> lifetimes,
                                std::span<const MemoryNeed> needs, const Placement& placement,
                                std::span<const Pending> left) {
  std::vector<std::uint32_t> transients;
  for (std::uint32_t r = 0; r < graph.resources.size(); ++r)
    if (!graph.resources[r].imported && lifetimes[r].used()) transients.push_back(r);
  std::vector<Pending> pending(graph.resources.size());
  for (const std::uint32_t r : transients) {
    const std::uint64_t begin = placement.offset[r], end = begin + needs[r].size;
    for (const std::uint32_t other : transients) {
      if (lifetimes[other].last >= lifetimes[r].first) continue;
      if (needs[other].memory_class != needs[r].memory_class) continue;
      const std::uint64_t other_begin = placement.offset[other];
      if (other_begin >= end || begin >= other_begin + needs[other].size) continue;
      pending[r].add(left[other]);
    }
  }
  return pending;
}

}  // namespace neritic::graph
