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

void record_clear(VkCommandBuffer cmd, const gpu::Image& image) {
  const VkImageSubresourceRange all{image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0,
                                    VK_REMAINING_ARRAY_LAYERS};
  const AccessInfo& clear = access_info(Access::kTransferWrite);
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.dstStageMask = clear.stages;
  barrier.dstAccessMask = clear.access;
  barrier.newLayout = clear.layout;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.handle();
  barrier.subresourceRange = all;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(cmd, &info);
  if (gpu::is_depth_format(image.desc().format)) {
    const VkClearDepthStencilValue zero{};
    vkCmdClearDepthStencilImage(cmd, image.handle(), clear.layout, &zero, 1, &all);
  } else {
    const VkClearColorValue zero{};
    vkCmdClearColorImage(cmd, image.handle(), clear.layout, &zero, 1, &all);
  }
}

void BarrierRecorder::add(const Barrier& barrier, const std::vector<const gpu::Image*>& images,
                          const std::vector<const gpu::Buffer*>& buffers) {
  // Memory that changes hands: the last owner's writes are not accesses to the new object, whose
  // own barrier would not cover them. One memory barrier does, for all that change hands here.
  if (barrier.discards && barrier.src_access != 0) {
    takeover_.srcStageMask |= barrier.src_stages;
    takeover_.srcAccessMask |= barrier.src_access;
    takeover_.dstStageMask |= barrier.dst_stages;
    takeover_.dstAccessMask |= barrier.dst_access;
  }
  if (const gpu::Image* image = images[barrier.resource]) {
    image_barriers_.push_back(image_barrier(barrier, *image));
  } else {
    const gpu::Buffer* buffer = buffers[barrier.resource];
    NERITIC_CHECK(buffer, "resource {} has no object", barrier.resource);
    buffer_barriers_.push_back(buffer_barrier(barrier, *buffer));
  }
}

void BarrierRecorder::record(VkCommandBuffer cmd, std::span<const Barrier> first,
                             std::span<const Barrier> more,
                             const std::vector<const gpu::Image*>& images,
                             const std::vector<const gpu::Buffer*>& buffers) {
  if (first.empty() && more.empty()) return;
  image_barriers_.clear();
  buffer_barriers_.clear();
  takeover_ = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  for (const Barrier& barrier : first) add(barrier, images, buffers);
  for (const Barrier& barrier : more) add(barrier, images, buffers);
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.memoryBarrierCount = takeover_.srcStageMask != 0 ? 1 : 0;
  info.pMemoryBarriers = &takeover_;
  info.imageMemoryBarrierCount = static_cast<std::uint32_t>(image_barriers_.size());
  info.pImageMemoryBarriers = image_barriers_.data();
  info.bufferMemoryBarrierCount = static_cast<std::uint32_t>(buffer_barriers_.size());
  info.pBufferMemoryBarriers = buffer_barriers_.data();
  vkCmdPipelineBarrier2(cmd, &info);
}

}  // namespace neritic::graph
