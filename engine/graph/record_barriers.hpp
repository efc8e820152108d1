// Inside engine/graph: a list of planned barriers as one vkCmdPipelineBarrier2. Rendering thread.
#pragma once

#include <span>
#include <vector>

#include "engine/gpu/resources.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {

// Orders all that was submitted before against all that comes after.
void record_frame_barrier(VkCommandBuffer cmd);

// Keeps its arrays between calls, so that a frame allocates nothing.
class BarrierRecorder {
 public:
  // images, buffers: by resource. Records nothing for an empty list.
  void record(VkCommandBuffer cmd, std::span<const Barrier> barriers,
              const std::vector<const gpu::Image*>& images,
              const std::vector<const gpu::Buffer*>& buffers);

 private:
  std::vector<VkImageMemoryBarrier2> image_barriers_;
  std::vector<VkBufferMemoryBarrier2> buffer_barriers_;
};

}  // namespace neritic::graph
