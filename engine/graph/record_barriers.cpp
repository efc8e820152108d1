// See record_barriers.hpp.
#include "engine/graph/record_barriers.hpp"

#include "engine/core/check.hpp"

namespace neritic::graph {
namespace {

VkImageMemoryBarrier2 image_barrier(const Barrier& barrier, const gpu::Image& image) {
  VkImageMemoryBarrier2 info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  info.srcStageMask = barrier.src_stages;
  info.srcAccessMask = barrier.src_access;
  info.dstStageMask = barrier.dst_stages;
  info.dstAccessMask = barrier.dst_access;
  info.oldLayout = barrier.old_layout;
  info.newLayout = barrier.new_layout;
  info.srcQueueFamilyIndex = info.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  info.image = image.handle();
  info.subresourceRange = {image.aspect(), barrier.range.mip, barrier.range.mips,
                           barrier.range.layer, barrier.range.layers};
  return info;
}

VkBufferMemoryBarrier2 buffer_barrier(const Barrier& barrier, const gpu::Buffer& buffer) {
  VkBufferMemoryBarrier2 info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2;
  info.srcStageMask = barrier.src_stages;
  info.srcAccessMask = barrier.src_access;
  info.dstStageMask = barrier.dst_stages;
  info.dstAccessMask = barrier.dst_access;
  info.srcQueueFamilyIndex = info.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  info.buffer = buffer.handle();
  info.size = VK_WHOLE_SIZE;
  return info;
}

}  // namespace

void record_frame_barrier(VkCommandBuffer cmd) {
  VkMemoryBarrier2 all{};
  all.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  all.srcStageMask = all.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  all.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  all.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &all;
  vkCmdPipelineBarrier2(cmd, &info);
}

void BarrierRecorder::record(VkCommandBuffer cmd, std::span<const Barrier> barriers,
                             const std::vector<const gpu::Image*>& images,
                             const std::vector<const gpu::Buffer*>& buffers) {
  if (barriers.empty()) return;
  image_barriers_.clear();
  buffer_barriers_.clear();
  // Memory that changes hands: the last owner's writes are not accesses to the new object, whose
  // own barrier would not cover them. One memory barrier does, for all that change hands here.
  VkMemoryBarrier2 takeover{};
  takeover.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  for (const Barrier& barrier : barriers) {
    if (barrier.discards && barrier.src_access != 0) {
      takeover.srcStageMask |= barrier.src_stages;
      takeover.srcAccessMask |= barrier.src_access;
      takeover.dstStageMask |= barrier.dst_stages;
      takeover.dstAccessMask |= barrier.dst_access;
    }
    if (const gpu::Image* image = images[barrier.resource]) {
      image_barriers_.push_back(image_barrier(barrier, *image));
    } else {
      const gpu::Buffer* buffer = buffers[barrier.resource];
      NERITIC_CHECK(buffer, "resource {} has no object", barrier.resource);
      buffer_barriers_.push_back(buffer_barrier(barrier, *buffer));
    }
  }
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.memoryBarrierCount = takeover.srcStageMask != 0 ? 1 : 0;
  info.pMemoryBarriers = &takeover;
  info.imageMemoryBarrierCount = static_cast<std::uint32_t>(image_barriers_.size());
  info.pImageMemoryBarriers = image_barriers_.data();
  info.bufferMemoryBarrierCount = static_cast<std::uint32_t>(buffer_barriers_.size());
  info.pBufferMemoryBarriers = buffer_barriers_.data();
  vkCmdPipelineBarrier2(cmd, &info);
}

}  // namespace neritic::graph
