// Fifth stage: where each transient lies in its class's heap. Largest first, each into the smallest
// gap between the resources that live at the same time (best fit); a resource whose lifetime is
// over leaves its bytes to others. Pure; any thread.
#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {
namespace {

std::uint64_t align_up(std::uint64_t value, std::uint64_t alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

bool overlap(const Lifetime& a, const Lifetime& b) {
  return a.first <= b.last && b.first <= a.last;
}

struct Range {
  std::uint64_t begin, end;
};

// A piece of memory to place. It must not cross a multiple of block; 0: no such limit.
struct Piece {
  std::uint64_t size, alignment, block;
};

// The first offset from cursor on where the piece may lie.
std::uint64_t first_fit(std::uint64_t cursor, const Piece& piece) {
  const std::uint64_t offset = align_up(cursor, piece.alignment);
  if (piece.block == 0 || piece.size == 0) return offset;
  const bool whole = offset / piece.block == (offset + piece.size - 1) / piece.block;
  return whole ? offset : align_up(offset, piece.block);
}

// The offset in the smallest gap between busy ranges that takes the piece; else after them all.
std::uint64_t best_gap(std::vector<Range>& busy, const Piece& piece) {
  std::sort(busy.begin(), busy.end(), [](Range a, Range b) { return a.begin < b.begin; });
  std::uint64_t cursor = 0, best = 0, best_slack = ~std::uint64_t{0};
  for (const Range& range : busy) {
    const std::uint64_t offset = first_fit(cursor, piece);
    if (offset + piece.size <= range.begin) {
      const std::uint64_t slack = range.begin - (offset + piece.size);
      if (slack < best_slack) best = offset, best_slack = slack;
    }
    cursor = std::max(cursor, range.end);
  }
  return best_slack != ~std::uint64_t{0} ? best : first_fit(cursor, piece);
}

// Places the resources in turn; alias: those that never live together may share bytes.
void place_all(std::span<const std::uint32_t> by_size, std::span<const Lifetime> lifetimes,
               std::span<const MemoryNeed> needs, bool alias, Placement& result) {
  std::fill(result.heap_size.begin(), result.heap_size.end(), 0);
  std::vector<Range> busy;
  for (std::size_t i = 0; i < by_size.size(); ++i) {
    const std::uint32_t r = by_size[i];
    const MemoryNeed& need = needs[r];
    busy.clear();
    for (const std::uint32_t other : by_size.first(i)) {
      if (needs[other].memory_class != need.memory_class) continue;
      if (!alias || overlap(lifetimes[other], lifetimes[r]))
        busy.push_back({result.offset[other], result.offset[other] + needs[other].size});
    }
    result.offset[r] = best_gap(busy, {need.size, need.alignment, need.block_bytes});
    std::uint64_t& heap = result.heap_size[need.memory_class];
    heap = std::max(heap, result.offset[r] + need.size);
  }
}

std::uint64_t total(const Placement& placement) {
  std::uint64_t sum = 0;
  for (const std::uint64_t size : placement.heap_size) sum += size;
  return sum;
}

}  // namespace

Placement place(const GraphDecl& graph, std::span<const Lifetime> lifetimes,
                std::span<const MemoryNeed> needs) {
  const std::size_t count = graph.resources.size();
  NERITIC_CHECK(lifetimes.size() == count && needs.size() == count,
                "{} resources, {} lives, {} needs", count, lifetimes.size(), needs.size());
  std::vector<std::uint32_t> by_size;
  std::uint32_t classes = 0;
  for (std::uint32_t r = 0; r < count; ++r) {
    if (graph.resources[r].imported || !lifetimes[r].used()) continue;
    NERITIC_CHECK(needs[r].alignment > 0, "\"{}\" has alignment 0", graph.resources[r].name);
    NERITIC_CHECK(needs[r].block_bytes % needs[r].alignment == 0 &&
                      (needs[r].block_bytes == 0 || needs[r].size <= needs[r].block_bytes),
                  "\"{}\" of {} bytes, aligned to {}, in blocks of {}", graph.resources[r].name,
                  needs[r].size, needs[r].alignment, needs[r].block_bytes);
    by_size.push_back(r);
    classes = std::max(classes, needs[r].memory_class + 1);
  }
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return needs[a].size > needs[b].size; });

  Placement apart, shared;
  apart.offset.assign(count, 0);
  apart.heap_size.assign(classes, 0);
  shared = apart;
  place_all(by_size, lifetimes, needs, false, apart);
  place_all(by_size, lifetimes, needs, true, shared);
  const std::uint64_t bytes_without = total(apart);
  // Greedy placement around alignments could in principle lose to placing everything apart.
  Placement& result = total(shared) <= bytes_without ? shared : apart;
  result.bytes_without = bytes_without;
  result.bytes_with_aliasing = total(result);
  return std::move(result);
}

}  // namespace neritic::graph
