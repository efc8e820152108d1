// Sixth stage: the barriers between the passes. The uses of each resource, in order, fall into
// epochs: one write, or a run of reads in one layout. A barrier stands before the first use of each
// epoch; it waits for the whole epoch before and serves the whole epoch after, so later reads of
// the same run need none. Pure; any thread.
//
// Why one step back is enough: an epoch's barrier waits for the stages of the epoch before, whose
// own barrier waited for the one before that (an execution dependency chain, Vulkan 1.3
// specification, section 7.1), and whatever was written was made available by the barrier right
// after it.
//
// The Executor opens each frame with one ALL_COMMANDS -> ALL_COMMANDS memory barrier. First uses of
// transients chain to it, which orders them after the memory's last use in the frame before.
#include <algorithm>

#include "engine/graph/access.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {
namespace {

struct Epoch {
  std::uint32_t position = 0;  // of its first use; the order's size for outputs
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  bool write = false;
  VkAccessFlags2 written() const { return write ? access & kWriteAccess : 0; }
};

using Epochs = std::vector<std::vector<Epoch>>;  // by resource

void append(std::vector<Epoch>& epochs, const CombinedUse& use, std::uint32_t position) {
  if (!use.write && !epochs.empty()) {
    Epoch& last = epochs.back();
    if (!last.write && last.layout == use.layout) {
      last.stages |= use.stages;
      last.access |= use.access;
      return;
    }
  }
  epochs.push_back({position, use.stages, use.access, use.layout, use.write});
}

Epochs find_epochs(const GraphDecl& graph, std::span<const std::uint32_t> order) {
  Epochs epochs(graph.resources.size());
  std::vector<CombinedUse> uses;
  for (std::uint32_t position = 0; position < order.size(); ++position) {
    combine_uses(graph, graph.passes[order[position]].uses, uses);
    for (const CombinedUse& use : uses) append(epochs[use.resource], use, position);
  }
  combine_uses(graph, graph.outputs, uses);
  for (const CombinedUse& use : uses)
    append(epochs[use.resource], use, static_cast<std::uint32_t>(order.size()));
  return epochs;
}

Barrier between(std::uint32_t resource, const Epoch& before, const Epoch& after) {
  Barrier barrier;
  barrier.resource = resource;
  barrier.src_stages = before.stages;
  barrier.src_access = before.written();
  barrier.dst_stages = after.stages;
  barrier.dst_access = after.access;
  barrier.old_layout = before.layout;
  barrier.new_layout = after.layout;
  return barrier;
}

Epoch initial_epoch(const ResourceDecl& resource) {
  Epoch epoch;
  epoch.stages = resource.initial_stages;
  epoch.access = resource.initial_access;
  if (resource.kind == ResourceKind::kImage) epoch.layout = resource.initial_layout;
  epoch.write = (resource.initial_access & kWriteAccess) != 0;
  return epoch;
}

// An imported resource that nobody touched lately, or whose readers include the new ones, is ready.
bool ready(const Epoch& initial, const Epoch& first) {
  if (initial.layout != first.layout) return false;
  if (initial.stages == 0 && initial.access == 0) return true;
  if (initial.write || first.write) return false;
  return (first.stages & ~initial.stages) == 0 && (first.access & ~initial.access) == 0;
}

// --- Memory taken over from another resource ---------------------------------------------------

class Takeover {
 public:
  Takeover(const GraphDecl& graph, std::span<const Lifetime> lifetimes,
           std::span<const MemoryNeed> needs, const Placement& placement)
      : lifetimes_(lifetimes), needs_(needs), placement_(placement) {
    for (std::uint32_t r = 0; r < graph.resources.size(); ++r)
      if (!graph.resources[r].imported && lifetimes[r].used()) transients_.push_back(r);
  }

  // Who had a byte of the resource's memory before it, the last and all earlier ones. Waiting for
  // the last would do, since earlier ones are ordered through it; but the validation layer follows
  // such a chain only through images that it takes for aliases of each other, and reports a hazard
  // otherwise.
  void previous_owners(std::uint32_t resource, std::vector<std::uint32_t>& owners) const {
    owners.clear();
    for (const std::uint32_t other : transients_) {
      if (lifetimes_[other].last >= lifetimes_[resource].first) continue;
      if (needs_[other].memory_class != needs_[resource].memory_class) continue;
      const std::uint64_t begin = placement_.offset[resource],
                          other_begin = placement_.offset[other];
      if (begin < other_begin + needs_[other].size && other_begin < begin + needs_[resource].size)
        owners.push_back(other);
    }
  }

 private:
  std::span<const Lifetime> lifetimes_;
  std::span<const MemoryNeed> needs_;
  const Placement& placement_;
  std::vector<std::uint32_t> transients_;
};

}  // namespace

BarrierPlan barriers(const GraphDecl& graph, std::span<const std::uint32_t> order,
                     std::span<const Lifetime> lifetimes, std::span<const MemoryNeed> needs,
                     const Placement& placement) {
  BarrierPlan plan;
  plan.before.resize(order.size());
  const auto emit = [&](const Barrier& barrier, std::uint32_t position) {
    (position < order.size() ? plan.before[position] : plan.at_end).push_back(barrier);
  };
  const Epochs epochs = find_epochs(graph, order);
  const Takeover takeover(graph, lifetimes, needs, placement);
  std::vector<std::uint32_t> owners;

  for (std::uint32_t r = 0; r < graph.resources.size(); ++r) {
    if (epochs[r].empty()) continue;
    const ResourceDecl& resource = graph.resources[r];
    const Epoch& first = epochs[r].front();
    if (resource.imported) {
      const Epoch initial = initial_epoch(resource);
      if (!ready(initial, first)) {
        Barrier barrier = between(r, initial, first);
        barrier.discards =
            resource.kind == ResourceKind::kImage && initial.layout == VK_IMAGE_LAYOUT_UNDEFINED;
        emit(barrier, first.position);
      }
    } else {
      Epoch before;  // whatever had the memory before
      takeover.previous_owners(r, owners);
      for (const std::uint32_t owner : owners) {
        const Epoch& last = epochs[owner].back();
        before.stages |= last.stages;
        before.access |= last.written();
        before.write |= last.write;
      }
      // Nobody did in this frame: the layout change chains to the barrier that opens the frame.
      if (owners.empty()) before.stages = first.stages;
      if (!owners.empty() || resource.kind == ResourceKind::kImage) {
        Barrier barrier = between(r, before, first);
        barrier.discards = true;
        emit(barrier, first.position);
      }
    }
    for (std::size_t e = 1; e < epochs[r].size(); ++e)
      emit(between(r, epochs[r][e - 1], epochs[r][e]), epochs[r][e].position);
  }
  return plan;
}

}  // namespace neritic::graph
