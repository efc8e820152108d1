// Inside engine/graph: a list of planned barriers as one vkCmdPipelineBarrier2. Rendering thread.
#pragma once

#include <span>
#include <vector>

#include "engine/gpu/resources.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {

// Clears the whole image to zero. It needs no contents, and is left in TRANSFER_DST_OPTIMAL with
// the clear pending.
void record_clear(VkCommandBuffer cmd, const gpu::Image& image);

// Keeps its arrays between calls, so that a frame allocates nothing.
class BarrierRecorder {
 public:
  // images, buffers: by resource. Records nothing for two empty lists.
  void record(VkCommandBuffer cmd, std::span<const Barrier> first, std::span<const Barrier> more,
              const std::vector<const gpu::Image*>& images,
              const std::vector<const gpu::Buffer*>& buffers);

 private:
  void add(const Barrier& barrier, const std::vector<const gpu::Image*>& images,
           const std::vector<const gpu::Buffer*>& buffers);
  VkMemoryBarrier2 takeover_{};
  std::vector<VkImageMemoryBarrier2> image_barriers_;
  std::vector<VkBufferMemoryBarrier2> buffer_barriers_;
};

}  // namespace neritic::graph
