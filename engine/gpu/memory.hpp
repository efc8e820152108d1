// A block allocator for device memory: blocks of 64 MiB (larger requests get a block of their own),
// first fit over a sorted free list, buffers and images in separate blocks (no granularity puzzle).
// Owned by the Device; called from the rendering thread only.
#pragma once

#include <volk.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::gpu {

class Device;

enum class MemoryUse {
  kDevice,    // GPU only
  kUpload,    // host writes, GPU reads; mapped, coherent
  kReadback,  // GPU writes, host reads; mapped, coherent, cached where there is such a type
};

// A piece of a block. Move-only: destruction gives it back.
class Allocation {
 public:
  Allocation() = default;
  Allocation(Allocation&& other) noexcept;
  Allocation& operator=(Allocation&& other) noexcept;
  ~Allocation();
  VkDeviceMemory memory() const;
  VkDeviceSize offset() const { return offset_; }
  VkDeviceSize size() const { return size_; }
  std::byte* mapped() const;  // nullptr for kDevice

 private:
  friend class Allocator;
  class Allocator* allocator_ = nullptr;
  void* block_ = nullptr;
  VkDeviceSize offset_ = 0, size_ = 0;
};

struct MemoryStatistics {
  VkDeviceSize reserved_bytes = 0, used_bytes = 0;
  std::uint32_t blocks = 0, allocations = 0;
};

class Allocator {
 public:
  explicit Allocator(const Device& device);
  ~Allocator();
  // kOutOfMemory names the size. linear: buffers; !linear: optimally tiled images.
  Result<Allocation> allocate(const VkMemoryRequirements& needs, MemoryUse use, bool linear);
  // The most bytes that one allocation may ask for, of what the requirements' types and use choose.
  VkDeviceSize largest_piece(std::uint32_t memory_type_bits, MemoryUse use) const;
  MemoryStatistics statistics() const;
  // Gives blocks that hold nothing back to the driver (one a kind is kept for the next request).
  void trim();

 private:
  friend class Allocation;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace neritic::gpu
