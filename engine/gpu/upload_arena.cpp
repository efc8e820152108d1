#include "engine/gpu/upload_arena.hpp"

#include <algorithm>
#include <bit>

#include "engine/gpu/device.hpp"

namespace neritic::gpu {
namespace {
constexpr VkDeviceSize kFirstChunkBytes = VkDeviceSize{1} << 18;
constexpr VkDeviceSize kSmallestAlignment = 64;  // a cache line; more than any copy asks for
}  // namespace

UploadArena::UploadArena(const Device& device, std::string name)
    : device_(&device),
      name_(std::move(name)),
      alignment_(std::max({kSmallestAlignment, device.limits().minStorageBufferOffsetAlignment,
                           device.limits().minUniformBufferOffsetAlignment})) {}

Status UploadArena::add_chunk(VkDeviceSize size) {
  BufferDesc desc;
  desc.name = name_;
  desc.size = size;
  desc.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
               VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
               VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  desc.memory = MemoryUse::kUpload;
  NERITIC_TRY(Buffer chunk, Buffer::create(*device_, desc));
  chunks_.push_back(std::move(chunk));
  used_ = 0;
  return {};
}

Result<UploadArena::Place> UploadArena::allocate(VkDeviceSize size) {
  if (chunks_.empty() || chunks_.back().size() - std::min(used_, chunks_.back().size()) < size) {
    const VkDeviceSize grown = chunks_.empty() ? kFirstChunkBytes : 2 * chunks_.back().size();
    NERITIC_TRY_STATUS(add_chunk(std::max(grown, size)));
  }
  const Buffer& chunk = chunks_.back();
  const Place place{chunk.handle(), used_, chunk.mapped<std::byte>().data() + used_};
  used_ = (used_ + size + alignment_ - 1) / alignment_ * alignment_;
  return place;
}

Status UploadArena::reset() {
  used_ = 0;
  if (chunks_.size() < 2) return {};
  VkDeviceSize total = 0;
  for (const Buffer& chunk : chunks_) total += chunk.size();
  chunks_.clear();
  return add_chunk(total);
}

}  // namespace neritic::gpu
