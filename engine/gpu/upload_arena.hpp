// Inside engine/gpu only: mapped memory that one frame's data goes into, given back all at once.
// Grows by further chunks; the next frame gets one chunk that would have held all. Rendering
// thread.
#pragma once

#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/resources.hpp"

namespace neritic::gpu {

class UploadArena {
 public:
  UploadArena(const Device& device, std::string name);

  struct Place {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    std::byte* mapped = nullptr;
  };
  // Offsets fit storage, uniform and copy use.
  Result<Place> allocate(VkDeviceSize size);
  // Every place becomes invalid; the GPU must be done with them.
  Status reset();

  std::size_t chunk_count() const { return chunks_.size(); }

 private:
  Status add_chunk(VkDeviceSize size);
  const Device* device_;
  std::string name_;
  VkDeviceSize alignment_;
  std::vector<Buffer> chunks_;
  VkDeviceSize used_ = 0;  // of the last chunk
};

}  // namespace neritic::gpu
