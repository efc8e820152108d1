#include "engine/gpu/memory.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/error.hpp"
#include "engine/gpu/free_list.hpp"

namespace neritic::gpu {
namespace {

constexpr VkDeviceSize kBlockBytes = VkDeviceSize{64} << 20;
// One block takes at most 1 / kHeapParts of a small heap (a 256 MiB window into a graphics card).
constexpr VkDeviceSize kHeapParts = 8;

// Memory properties that a use must have, would like, and would rather avoid.
struct Wish {
  VkMemoryPropertyFlags must, like, avoid;
};

Wish wish_of(MemoryUse use) {
  constexpr VkMemoryPropertyFlags kHost =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  switch (use) {
    case MemoryUse::kDevice:
      return {0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT};
    case MemoryUse::kUpload:
      return {kHost, 0, VK_MEMORY_PROPERTY_HOST_CACHED_BIT | VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
    case MemoryUse::kReadback:
      return {kHost, VK_MEMORY_PROPERTY_HOST_CACHED_BIT, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
  }
  return {};
}

std::optional<std::uint32_t> choose_type(const VkPhysicalDeviceMemoryProperties& memory,
                                         std::uint32_t type_bits, MemoryUse use) {
  // Kinds that ordinary resources must not be put in.
  constexpr VkMemoryPropertyFlags kNever =
      VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT | VK_MEMORY_PROPERTY_PROTECTED_BIT |
      VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD | VK_MEMORY_PROPERTY_DEVICE_UNCACHED_BIT_AMD;
  const Wish wish = wish_of(use);
  std::optional<std::uint32_t> best;
  int best_score = -1;
  for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    const VkMemoryPropertyFlags flags = memory.memoryTypes[i].propertyFlags;
    if (!(type_bits & (1u << i)) || (flags & wish.must) != wish.must || (flags & kNever)) continue;
    const int score =
        ((flags & wish.like) == wish.like ? 2 : 0) + ((flags & wish.avoid) == 0 ? 1 : 0);
    if (score > best_score) {
      best = i;
      best_score = score;
    }
  }
  return best;
}

}  // namespace

struct Allocator::Impl {
  struct PoolKey {
    std::uint32_t type = 0;
    bool linear = true;
    bool mapped = false;
    bool operator==(const PoolKey&) const = default;
  };

  struct Block {
    PoolKey key;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::byte* mapped = nullptr;
    bool own = false;  // made for one large request
    FreeList free;
  };

  VkDevice device = VK_NULL_HANDLE;
  const Device* owner = nullptr;
  VkPhysicalDeviceMemoryProperties memory{};
  VkDeviceSize largest_allocation = 0;
  std::vector<std::unique_ptr<Block>> blocks;
  VkDeviceSize used_bytes = 0;
  std::uint32_t allocations = 0;

  VkDeviceSize heap_bytes(std::uint32_t type) const {
    return memory.memoryHeaps[memory.memoryTypes[type].heapIndex].size;
  }
  VkDeviceSize block_bytes(std::uint32_t type) const {
    return std::min(kBlockBytes, heap_bytes(type) / kHeapParts);
  }
  Result<Block*> add_block(const PoolKey& key, VkDeviceSize size, bool own);
  void destroy(Block& block) const {
    if (block.mapped) vkUnmapMemory(device, block.memory);
    vkFreeMemory(device, block.memory, nullptr);
  }
  template <class Predicate>
  void destroy_if(const Predicate& predicate) {
    std::erase_if(blocks, [&](const std::unique_ptr<Block>& block) {
      if (!predicate(*block)) return false;
      destroy(*block);
      return true;
    });
  }
  void release(Block* block, VkDeviceSize offset, VkDeviceSize size);
};

Result<Allocator::Impl::Block*> Allocator::Impl::add_block(const PoolKey& key, VkDeviceSize size,
                                                           bool own) {
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = size;
  info.memoryTypeIndex = key.type;
  auto block = std::make_unique<Block>(Block{key, VK_NULL_HANDLE, nullptr, own, FreeList(size)});
  const VkResult result = vkAllocateMemory(device, &info, nullptr, &block->memory);
  if (result != VK_SUCCESS)
    return vulkan_error(result, fmt::format("vkAllocateMemory of {} bytes", size));
  if (key.mapped) {
    void* mapped = nullptr;
    const VkResult map_result = vkMapMemory(device, block->memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    if (map_result != VK_SUCCESS) {
      vkFreeMemory(device, block->memory, nullptr);
      return vulkan_error(map_result, fmt::format("vkMapMemory of {} bytes", size));
    }
    block->mapped = static_cast<std::byte*>(mapped);
  }
  owner->name_object(VK_OBJECT_TYPE_DEVICE_MEMORY, block->memory,
                     fmt::format("{} block of type {}{}", key.linear ? "buffer" : "image", key.type,
                                 own ? " for one resource" : ""));
  blocks.push_back(std::move(block));
  return blocks.back().get();
}

void Allocator::Impl::release(Block* block, VkDeviceSize offset, VkDeviceSize size) {
  block->free.release(offset, size);
  used_bytes -= size;
  --allocations;
  if (!block->free.all_free()) return;
  // One empty block a kind stays for the next request; large ones go at once.
  const auto spare = [&](const std::unique_ptr<Block>& other) {
    return other.get() != block && !other->own && other->key == block->key &&
           other->free.all_free();
  };
  if (block->own || std::any_of(blocks.begin(), blocks.end(), spare))
    destroy_if([&](const Block& b) { return &b == block; });
}

Allocator::Allocator(const Device& device) : impl_(std::make_unique<Impl>()) {
  impl_->device = device.handle();
  impl_->owner = &device;
  vkGetPhysicalDeviceMemoryProperties(device.physical(), &impl_->memory);
  VkPhysicalDeviceMaintenance3Properties limits{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &limits};
  vkGetPhysicalDeviceProperties2(device.physical(), &all);
  impl_->largest_allocation = limits.maxMemoryAllocationSize;
}

Allocator::~Allocator() {
  NERITIC_CHECK(impl_->allocations == 0, "the Device goes away while {} pieces of its memory live",
                impl_->allocations);
  trim();
}

void Allocator::trim() {
  impl_->destroy_if([](const Impl::Block& block) { return block.free.all_free(); });
}

Result<Allocation> Allocator::allocate(const VkMemoryRequirements& needs, MemoryUse use,
                                       bool linear) {
  const auto type = choose_type(impl_->memory, needs.memoryTypeBits, use);
  if (!type)
    return failure(ErrorCode::kUnsupported, "no memory type of {:#x} fits a {}",
                   needs.memoryTypeBits, linear ? "buffer" : "image");
  const VkDeviceSize most = largest_piece(needs.memoryTypeBits, use);
  if (needs.size > most)  // not a valid request; lavapipe would try all the same
    return failure(ErrorCode::kOutOfMemory, "{} bytes in one piece, the device gives at most {}",
                   needs.size, most);
  const Impl::PoolKey key{*type, linear, use != MemoryUse::kDevice};
  Impl::Block* block = nullptr;
  std::optional<VkDeviceSize> offset;
  if (needs.size <= impl_->block_bytes(*type)) {
    for (const auto& candidate : impl_->blocks) {
      if (candidate->own || !(candidate->key == key)) continue;
      offset = candidate->free.allocate(needs.size, needs.alignment);
      if (!offset) continue;
      block = candidate.get();
      break;
    }
    if (!offset) {
      NERITIC_TRY(block, impl_->add_block(key, impl_->block_bytes(*type), false));
      offset = block->free.allocate(needs.size, needs.alignment);
    }
  } else {
    NERITIC_TRY(block, impl_->add_block(key, needs.size, true));
    offset = block->free.allocate(needs.size, needs.alignment);
  }
  NERITIC_CHECK(offset.has_value(), "a fresh block cannot hold {} bytes", needs.size);
  impl_->used_bytes += needs.size;
  ++impl_->allocations;
  Allocation allocation;
  allocation.allocator_ = this;
  allocation.block_ = block;
  allocation.offset_ = *offset;
  allocation.size_ = needs.size;
  return allocation;
}

VkDeviceSize Allocator::largest_piece(std::uint32_t memory_type_bits, MemoryUse use) const {
  const auto type = choose_type(impl_->memory, memory_type_bits, use);
  return type ? std::min(impl_->heap_bytes(*type), impl_->largest_allocation) : 0;
}

MemoryStatistics Allocator::statistics() const {
  MemoryStatistics out;
  for (const auto& block : impl_->blocks) out.reserved_bytes += block->free.size_bytes();
  out.used_bytes = impl_->used_bytes;
  out.blocks = static_cast<std::uint32_t>(impl_->blocks.size());
  out.allocations = impl_->allocations;
  return out;
}

Allocation::Allocation(Allocation&& other) noexcept {
  *this = std::move(other);
}

Allocation& Allocation::operator=(Allocation&& other) noexcept {
  std::swap(allocator_, other.allocator_);
  std::swap(block_, other.block_);
  std::swap(offset_, other.offset_);
  std::swap(size_, other.size_);
  return *this;
}

Allocation::~Allocation() {
  if (allocator_)
    allocator_->impl_->release(static_cast<Allocator::Impl::Block*>(block_), offset_, size_);
}

VkDeviceMemory Allocation::memory() const {
  return block_ ? static_cast<const Allocator::Impl::Block*>(block_)->memory : VK_NULL_HANDLE;
}

std::byte* Allocation::mapped() const {
  const auto* block = static_cast<const Allocator::Impl::Block*>(block_);
  return block && block->mapped ? block->mapped + offset_ : nullptr;
}

}  // namespace neritic::gpu
