// See transient_heaps.hpp.
#include "engine/graph/transient_heaps.hpp"

#include <algorithm>

#include "engine/core/check.hpp"

namespace neritic::graph {
namespace {

// A class is its kind and its memory types; the alignment is a need.
bool same_class(const MemoryClass& a, const MemoryClass& b) {
  return a.kind == b.kind && a.memory_type_bits == b.memory_type_bits;
}

}  // namespace

void TransientHeaps::add(std::vector<Need>& needs, const MemoryClass& memory_class,
                         std::uint64_t size) {
  if (size == 0) return;
  for (Need& need : needs) {
    if (!same_class(need.memory_class, memory_class)) continue;
    need.size = std::max(need.size, size);
    need.memory_class.alignment = std::max(need.memory_class.alignment, memory_class.alignment);
    return;
  }
  needs.push_back({memory_class, size});
}

const TransientHeaps::Heap* TransientHeaps::find(const MemoryClass& memory_class) const {
  const auto at = std::find_if(heaps_.begin(), heaps_.end(), [&](const Heap& heap) {
    return same_class(heap.made_for.memory_class, memory_class);
  });
  return at == heaps_.end() ? nullptr : &*at;
}

bool TransientHeaps::fit(const std::vector<Need>& needs) const {
  std::uint64_t sum = 0;
  for (const Need& need : needs) {
    const Heap* heap = find(need.memory_class);
    if (!heap || heap->made_for.size < need.size ||
        heap->made_for.memory_class.alignment < need.memory_class.alignment)
      return false;
    sum += need.size;
  }
  return bytes() <= 2 * sum;
}

std::vector<gpu::Allocation> TransientHeaps::take() {
  std::vector<gpu::Allocation> taken;
  for (Heap& heap : heaps_)
    for (gpu::Allocation& block : heap.blocks) taken.push_back(std::move(block));
  heaps_.clear();
  return taken;
}

Status TransientHeaps::allocate(gpu::Allocator& allocator, const std::vector<Need>& needs) {
  NERITIC_CHECK(heaps_.empty(), "{} heaps", heaps_.size());
  for (const Need& need : needs) {
    const MemoryClass& c = need.memory_class;
    Heap heap{need, {}};
    for (std::uint64_t left = need.size; left > 0;) {
      VkMemoryRequirements wanted{};
      wanted.size = c.block_bytes == 0 ? left : std::min(left, c.block_bytes);
      wanted.alignment = c.alignment;
      wanted.memoryTypeBits = c.memory_type_bits;
      auto block =
          allocator.allocate(wanted, gpu::MemoryUse::kDevice, c.kind == ResourceKind::kBuffer);
      if (!block.ok())
        return Error{block.error().code, "transient memory of frames: " + block.error().message};
      heap.blocks.push_back(std::move(*block));
      left -= wanted.size;
    }
    heaps_.push_back(std::move(heap));
  }
  return {};
}

TransientHeaps::Place TransientHeaps::at(const MemoryClass& memory_class,
                                         std::uint64_t offset) const {
  const Heap* heap = find(memory_class);
  NERITIC_CHECK(heap, "no heap of memory types {:#x}", memory_class.memory_type_bits);
  const std::uint64_t length = heap->made_for.memory_class.block_bytes;
  const gpu::Allocation& block = heap->blocks[length == 0 ? 0 : offset / length];
  return {block.memory(), block.offset() + (length == 0 ? offset : offset % length)};
}

std::uint64_t TransientHeaps::bytes() const {
  std::uint64_t sum = 0;
  for (const Heap& heap : heaps_) sum += heap.made_for.size;
  return sum;
}

}  // namespace neritic::graph
