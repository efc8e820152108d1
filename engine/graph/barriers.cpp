// Sixth stage: the barriers between the passes. A barrier stands before the first use of each epoch
// (epochs.hpp) of a part of a resource; it waits for the whole epoch before and serves the whole
// epoch after, so later reads of the same run need none. Pure; any thread.
//
// Why one step back is enough: an epoch's barrier waits for the stages of the epoch before, whose
// own barrier waited for the one before that (an execution dependency chain, Vulkan 1.3
// specification, section 7.1), and whatever was written was made available by the barrier right
// after it.
//
// The Executor opens each frame with one ALL_COMMANDS -> ALL_COMMANDS memory barrier. First uses of
// transients chain to it, which orders them after the memory's last use in the frame before.
#include <algorithm>

#include "engine/graph/epochs.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {
namespace {

Barrier between(const Part& part, const Epoch& before, const Epoch& after) {
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

// One barrier for all parts of a resource that change alike. Parts come in order of mips, then
// layers, so that rows of layers grow first.
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

}  // namespace

BarrierPlan barriers(const GraphDecl& graph, std::span<const std::uint32_t> order,
                     std::span<const Lifetime> lifetimes, std::span<const MemoryNeed> needs,
                     const Placement& placement) {
  BarrierPlan plan;
  plan.before.resize(order.size());
  const auto emit = [&](const Barrier& barrier, std::uint32_t position) {
    (position < order.size() ? plan.before[position] : plan.at_end).push_back(barrier);
  };
  const std::vector<Part> parts = find_parts(graph, order);
  // How each resource is left: by resource, the last epochs of all its parts.
  std::vector<Epoch> left(graph.resources.size());
  for (const Part& part : parts) {
    if (part.epochs.empty()) continue;
    const Epoch& last = part.epochs.back();
    left[part.resource].stages |= last.stages;
    left[part.resource].access |= last.written();
    left[part.resource].write |= last.write;
  }
  const Takeover takeover(graph, lifetimes, needs, placement);
  std::vector<std::uint32_t> owners;

  bool in_parts = false;
  for (const Part& part : parts) {
    if (part.epochs.empty()) continue;
    const ResourceDecl& resource = graph.resources[part.resource];
    in_parts |= part.range != ImageRange{0, resource.mips, 0, resource.layers};
    const Epoch& first = part.epochs.front();
    if (resource.imported) {
      const Epoch initial = initial_epoch(resource);
      if (!ready(initial, first)) {
        Barrier barrier = between(part, initial, first);
        barrier.discards =
            resource.kind == ResourceKind::kImage && initial.layout == VK_IMAGE_LAYOUT_UNDEFINED;
        emit(barrier, first.position);
      }
    } else {
      Epoch before;  // whatever had the memory before
      takeover.previous_owners(part.resource, owners);
      for (const std::uint32_t owner : owners) {
        before.stages |= left[owner].stages;
        before.access |= left[owner].access;
        before.write |= left[owner].write;
      }
      // Nobody did in this frame: the layout change chains to the barrier that opens the frame.
      if (owners.empty()) before.stages = first.stages;
      if (!owners.empty() || resource.kind == ResourceKind::kImage) {
        Barrier barrier = between(part, before, first);
        barrier.discards = true;
        emit(barrier, first.position);
      }
    }
    for (std::size_t e = 1; e < part.epochs.size(); ++e)
      emit(between(part, part.epochs[e - 1], part.epochs[e]), part.epochs[e].position);
  }
  if (in_parts) {
    for (std::vector<Barrier>& list : plan.before) merge_parts(list);
    merge_parts(plan.at_end);
  }
  return plan;
}

}  // namespace neritic::graph
