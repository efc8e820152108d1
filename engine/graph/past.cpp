// See past.hpp. A run waits only for accesses to the same bytes: those of the object itself, or of
// the resources that its transient's memory had before. One wait is enough: later uses chain to the
// first (barriers.cpp).
#include "engine/graph/past.hpp"

#include <algorithm>
#include <iterator>

#include "engine/graph/barriers.hpp"

namespace neritic::graph {
namespace {

// The accesses that are pending: those that import's caller named and those that earlier runs left.
Epoch initial_epoch(const ResourceDecl& resource, const Epoch& left) {
  Epoch epoch = left;
  epoch.stages |= resource.initial_stages;
  epoch.access |= resource.initial_access;
  epoch.write |= (resource.initial_access & kWriteAccess) != 0;
  if (resource.history != History::kLast) epoch.layout = resource.initial_layout;
  if (resource.kind == ResourceKind::kBuffer) epoch.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  return epoch;
}

// Whether a part needs no barrier before its first use: nothing is pending, or readers before it
// include it. Later epochs wait for the first use only, so that then it must include the readers.
bool ready(const Epoch& initial, const Part& part) {
  const Epoch& first = part.epochs.front();
  if (initial.layout != first.layout) return false;
  if (initial.stages == 0 && initial.access == 0) return true;
  if (initial.write || first.write) return false;
  if (part.epochs.size() > 1 && (initial.stages & ~first.stages) != 0) return false;
  return (first.stages & ~initial.stages) == 0 && (first.access & ~initial.access) == 0;
}

// Whether a run only reads the part, in the layout that it finds.
bool only_reads(const Part& part, const Epoch& initial) {
  const Epoch& use = part.epochs.front();
  return part.epochs.size() == 1 && !use.write && use.layout == initial.layout;
}

}  // namespace

const Past::State& Past::object(std::uint64_t id) const {
  static const State kNever;
  const auto found = objects_.find(id);
  return found == objects_.end() ? kNever : found->second;
}

void Past::set_object(std::uint64_t id, State state) {
  objects_[id] = std::move(state);
}

void Past::settle() {
  heaps_.clear();
  for (auto object = objects_.begin(); object != objects_.end();) {
    bool known = false;
    for (Left& left : object->second) {
      left = {{.layout = left.use.layout}};
      known |= left.use.layout != VK_IMAGE_LAYOUT_UNDEFINED;
    }
    object = known ? std::next(object) : objects_.erase(object);
  }
}

void Past::run(const Plan& plan, std::span<const std::uint64_t> objects,
               std::span<const std::uint64_t> classes, std::vector<std::vector<Barrier>>& first) {
  ++runs_;
  first.resize(plan.order.size() + 1);
  for (std::vector<Barrier>& list : first) list.clear();

  // Memory changes hands in the order of first uses.
  by_first_.clear();
  for (std::uint32_t r = 0; r < plan.graph.resources.size(); ++r)
    if (!plan.graph.resources[r].imported && plan.lifetimes[r].used()) by_first_.push_back(r);
  std::stable_sort(by_first_.begin(), by_first_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return plan.lifetimes[a].first < plan.lifetimes[b].first;
  });
  in_part_.assign(plan.graph.resources.size(), false);
  for (const Part& part : plan.parts)
    if (part.epochs.empty()) in_part_[part.resource] = true;
  carried_.assign(plan.graph.resources.size(), {});
  for (const std::uint32_t r : by_first_) {
    const std::uint64_t begin = plan.placement.offset[r];
    carried_[r] = take_over(
        heaps_[classes[plan.needs[r].memory_class]],
        {begin, begin + plan.needs[r].size, runs_, plan.left[r], plan.takeover[r]}, in_part_[r]);
  }

  bool in_parts = false;
  for (const Part& part : plan.parts) {
    if (part.epochs.empty()) continue;
    const std::uint32_t r = part.resource;
    const ResourceDecl& resource = plan.graph.resources[r];
    if (resource.imported) {
      State& state = objects_[objects[r]];
      const std::size_t count = std::size_t{resource.mips} * resource.layers;
      if (state.size() != count) state.assign(count, {});
      in_parts |= count > 1;
      start_object(plan, part, state, first);
      continue;
    }
    const Epoch& use = part.epochs.front();
    Epoch before;
    before.stages = plan.takeover[r].stages | carried_[r].stages;
    before.access = plan.takeover[r].access | carried_[r].access;
    before.write = before.access != 0;
    if (resource.kind == ResourceKind::kBuffer && before.stages == 0) continue;
    Barrier barrier = barrier_between(part, before, use);
    barrier.discards = true;
    barrier.earlier = carried_[r].stages != 0;
    first[use.position].push_back(barrier);
    in_parts |= !part.is_whole(resource);
  }
  if (in_parts)
    for (std::vector<Barrier>& list : first) merge_parts(list);
}

void Past::start_object(const Plan& plan, const Part& part, State& state,
                        std::vector<std::vector<Barrier>>& first) {
  const ResourceDecl& resource = plan.graph.resources[part.resource];
  const Epoch& use = part.epochs.front();
  const ImageRange& range = part.range;
  for (std::uint32_t m = range.mip; m < range.mip + range.mips; ++m)
    for (std::uint32_t l = range.layer; l < range.layer + range.layers; ++l) {
      Left& left = state[std::size_t{m} * resource.layers + l];
      const Epoch initial = initial_epoch(resource, left.use);
      const bool settled =
          left.settled && resource.initial_stages == 0 && only_reads(part, initial);
      if (!settled && !ready(initial, part)) {
        Barrier barrier = barrier_between(part, initial, use);
        barrier.range = {m, 1, l, 1};
        barrier.discards =
            resource.kind == ResourceKind::kImage && initial.layout == VK_IMAGE_LAYOUT_UNDEFINED;
        barrier.earlier = left.use.stages != 0;
        first[use.position].push_back(barrier);
      }
      left = {part.epochs.back(), settled};
      if (only_reads(part, initial) && !initial.write) {  // a later write waits for all the reads
        left.use.stages |= initial.stages;
        left.use.access |= initial.access;
      }
      // The layout of an import is what its caller says.
      if (resource.history == History::kNone) left.use.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    }
}

Pending Past::take_over(std::vector<Segment>& heap, Segment segment, bool in_part) {
  Pending carried;
  pieces_.clear();
  for (const Segment& old : heap) {
    if (old.end <= segment.begin || segment.end <= old.begin) {
      pieces_.push_back(old);
      continue;
    }
    carried.add(old.untouched);
    if (old.run != runs_) carried.add(old.left);  // Plan::takeover orders uses of this run
    if (old.begin < segment.begin) {
      pieces_.push_back(old);
      pieces_.back().end = segment.begin;
    }
    if (segment.end < old.end) {
      pieces_.push_back(old);
      pieces_.back().begin = segment.end;
    }
  }
  if (in_part) {
    segment.untouched.add(carried);
  } else {
    segment.untouched = {};
  }
  pieces_.push_back(segment);
  heap.swap(pieces_);
  return carried;
}

}  // namespace neritic::graph
