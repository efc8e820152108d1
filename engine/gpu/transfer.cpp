// Work outside a frame: one-off submissions, filling buffers and images through staging, reading
// images back. Each blocks until the GPU is done. Rendering thread.
#include <algorithm>
#include <cstring>

#include "engine/core/check.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/error.hpp"
#include "engine/gpu/frames.hpp"

namespace neritic::gpu {
namespace {

constexpr VkDeviceSize kStagingBytes = VkDeviceSize{32} << 20;

// A command pool and fence that live for one submission.
struct OneShot {
  explicit OneShot(VkDevice handle) : device(handle) {}
  OneShot(const OneShot&) = delete;
  OneShot& operator=(const OneShot&) = delete;
  ~OneShot() {
    if (fence != VK_NULL_HANDLE) vkDestroyFence(device, fence, nullptr);
    if (pool != VK_NULL_HANDLE) vkDestroyCommandPool(device, pool, nullptr);
  }
  VkDevice device;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkFence fence = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
};

Status create(const Device& device, OneShot& shot) {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  pool.queueFamilyIndex = device.queue_family();
  NERITIC_TRY_VK("vkCreateCommandPool",
                 vkCreateCommandPool(device.handle(), &pool, nullptr, &shot.pool));
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = shot.pool;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  NERITIC_TRY_VK("vkAllocateCommandBuffers",
                 vkAllocateCommandBuffers(device.handle(), &info, &shot.commands));
  const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  NERITIC_TRY_VK("vkCreateFence", vkCreateFence(device.handle(), &fence, nullptr, &shot.fence));
  const std::string name = "one-off submission";
  device.name_object(VK_OBJECT_TYPE_COMMAND_POOL, shot.pool, name);
  device.name_object(VK_OBJECT_TYPE_COMMAND_BUFFER, shot.commands, name);
  device.name_object(VK_OBJECT_TYPE_FENCE, shot.fence, name);
  return {};
}

struct State {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;
};
constexpr State kFresh{VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED};
constexpr State kCopySource{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
constexpr State kCopyTarget{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
State anything(VkImageLayout layout) {
  return {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
          VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT, layout};
}

void transition(VkCommandBuffer commands, const Image& image, const State& from, const State& to,
                std::uint32_t first_mip, std::uint32_t mips, std::uint32_t first_layer,
                std::uint32_t layers) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = from.stages;
  barrier.srcAccessMask = from.access;
  barrier.dstStageMask = to.stages;
  barrier.dstAccessMask = to.access;
  barrier.oldLayout = from.layout;
  barrier.newLayout = to.layout;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.handle();
  barrier.subresourceRange = {image.aspect(), first_mip, mips, first_layer, layers};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

VkImageAspectFlags copy_aspect(const Image& image) {
  return is_depth_format(image.desc().format) ? VK_IMAGE_ASPECT_DEPTH_BIT
                                              : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkExtent3D mip_extent(const ImageDesc& desc, std::uint32_t mip) {
  return {std::max(desc.width >> mip, 1u), std::max(desc.height >> mip, 1u), 1};
}

Result<Buffer> staging_buffer(const Device& device, const std::string& name, VkDeviceSize size,
                              MemoryUse use) {
  BufferDesc desc;
  desc.name = name;
  desc.size = size;
  desc.usage = use == MemoryUse::kUpload ? VK_BUFFER_USAGE_TRANSFER_SRC_BIT
                                         : VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  desc.memory = use;
  return Buffer::create(device, desc);
}

// The filter to halve images of the format with; kUnsupported where the device cannot blit it.
Result<VkFilter> mip_filter(const Device& device, const ImageDesc& desc) {
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(device.physical(), desc.format, &properties);
  const VkFormatFeatureFlags have = properties.optimalTilingFeatures;
  constexpr VkFormatFeatureFlags kBlit =
      VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
  if ((have & kBlit) != kBlit)
    return failure(ErrorCode::kUnsupported, "image {}: the device cannot make mips of format {}",
                   desc.name, static_cast<int>(desc.format));
  return have & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT ? VK_FILTER_LINEAR
                                                                  : VK_FILTER_NEAREST;
}

// Halves mip by mip; each mip ends in TRANSFER_SRC, the last in TRANSFER_DST.
void record_mips(VkCommandBuffer commands, const Image& image, VkFilter filter) {
  const ImageDesc& desc = image.desc();
  for (std::uint32_t mip = 1; mip < desc.mips; ++mip) {
    transition(commands, image, kCopyTarget, kCopySource, mip - 1, 1, 0, desc.layers);
    const VkExtent3D from = mip_extent(desc, mip - 1), to = mip_extent(desc, mip);
    VkImageBlit2 region{VK_STRUCTURE_TYPE_IMAGE_BLIT_2};
    region.srcSubresource = {copy_aspect(image), mip - 1, 0, desc.layers};
    region.dstSubresource = {copy_aspect(image), mip, 0, desc.layers};
    region.srcOffsets[1] = {static_cast<std::int32_t>(from.width),
                            static_cast<std::int32_t>(from.height), 1};
    region.dstOffsets[1] = {static_cast<std::int32_t>(to.width),
                            static_cast<std::int32_t>(to.height), 1};
    VkBlitImageInfo2 info{VK_STRUCTURE_TYPE_BLIT_IMAGE_INFO_2};
    info.srcImage = image.handle();
    info.srcImageLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    info.dstImage = image.handle();
    info.dstImageLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    info.regionCount = 1;
    info.pRegions = &region;
    info.filter = filter;
    vkCmdBlitImage2(commands, &info);
  }
}

}  // namespace

void record_full_barrier(VkCommandBuffer commands) {
  VkMemoryBarrier2 all{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  all.srcStageMask = all.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  all.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  all.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &all;
  vkCmdPipelineBarrier2(commands, &info);
}

Status run_once(Device& device, const std::function<void(VkCommandBuffer)>& record) {
  OneShot shot(device.handle());
  NERITIC_TRY_STATUS(create(device, shot));
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  NERITIC_TRY_VK("vkBeginCommandBuffer", vkBeginCommandBuffer(shot.commands, &begin));
  record_full_barrier(shot.commands);
  record(shot.commands);
  record_full_barrier(shot.commands);
  NERITIC_TRY_VK("vkEndCommandBuffer", vkEndCommandBuffer(shot.commands));
  VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  commands.commandBuffer = shot.commands;
  VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &commands;
  NERITIC_TRY_VK("vkQueueSubmit2", vkQueueSubmit2(device.queue(), 1, &info, shot.fence));
  VkResult result =
      vkWaitForFences(device.handle(), 1, &shot.fence, VK_TRUE, device.wait_limit_ns());
  // The pool must not go away under the GPU, however long it takes; what is done then is done.
  if (result == VK_TIMEOUT) {
    device.wait_idle();
    result = vkGetFenceStatus(device.handle(), shot.fence);
  }
  if (result != VK_SUCCESS) return vulkan_error(result, "waiting for a one-off submission");
  return {};
}

Status upload_buffer(Device& device, const Buffer& target, std::span<const std::byte> bytes,
                     VkDeviceSize offset) {
  NERITIC_CHECK(offset <= target.size() && bytes.size() <= target.size() - offset,
                "{} bytes at {} into {}", bytes.size(), offset, target.size());
  if (bytes.empty()) return {};
  if (const auto mapped = target.mapped<std::byte>(); !mapped.empty()) {
    std::memcpy(mapped.data() + offset, bytes.data(), bytes.size());
    return {};
  }
  const VkDeviceSize chunk = std::min<VkDeviceSize>(bytes.size(), kStagingBytes);
  NERITIC_TRY(const Buffer staging,
              staging_buffer(device, "upload staging", chunk, MemoryUse::kUpload));
  for (VkDeviceSize done = 0; done < bytes.size(); done += chunk) {
    const VkDeviceSize size = std::min<VkDeviceSize>(chunk, bytes.size() - done);
    std::memcpy(staging.mapped<std::byte>().data(), bytes.data() + done, size);
    NERITIC_TRY_STATUS(run_once(device, [&](VkCommandBuffer commands) {
      const VkBufferCopy region{0, offset + done, size};
      vkCmdCopyBuffer(commands, staging.handle(), target.handle(), 1, &region);
    }));
  }
  return {};
}

Status upload_image(Device& device, const Image& target, std::span<const std::byte> texels_mip0) {
  const ImageDesc& desc = target.desc();
  const VkDeviceSize expected =
      VkDeviceSize{desc.width} * desc.height * desc.layers * texel_bytes(desc.format);
  NERITIC_CHECK(texels_mip0.size() == expected, "{}: {} bytes of texels, {} expected", desc.name,
                texels_mip0.size(), expected);
  VkFilter filter = VK_FILTER_NEAREST;
  if (desc.mips > 1) {
    NERITIC_TRY(filter, mip_filter(device, desc));
  }
  NERITIC_TRY(const Buffer staging,
              staging_buffer(device, "upload staging", expected, MemoryUse::kUpload));
  std::memcpy(staging.mapped<std::byte>().data(), texels_mip0.data(), texels_mip0.size());
  return run_once(device, [&](VkCommandBuffer commands) {
    transition(commands, target, kFresh, kCopyTarget, 0, desc.mips, 0, desc.layers);
    VkBufferImageCopy region{};
    region.imageSubresource = {copy_aspect(target), 0, 0, desc.layers};
    region.imageExtent = {desc.width, desc.height, 1};
    vkCmdCopyBufferToImage(commands, staging.handle(), target.handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    record_mips(commands, target, filter);
    const State sampled = anything(VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    if (desc.mips > 1)
      transition(commands, target, kCopySource, sampled, 0, desc.mips - 1, 0, desc.layers);
    transition(commands, target, kCopyTarget, sampled, desc.mips - 1, 1, 0, desc.layers);
  });
}

Result<std::vector<std::byte>> read_image(Device& device, const Image& image, VkImageLayout layout,
                                          std::uint32_t layer, std::uint32_t mip) {
  const ImageDesc& desc = image.desc();
  NERITIC_CHECK(layer < desc.layers && mip < desc.mips && layout != VK_IMAGE_LAYOUT_UNDEFINED,
                "{}: layer {} of {}, mip {} of {}, layout {}", desc.name, layer, desc.layers, mip,
                desc.mips, static_cast<int>(layout));
  const VkExtent3D extent = mip_extent(desc, mip);
  const VkDeviceSize size = VkDeviceSize{extent.width} * extent.height * texel_bytes(desc.format);
  NERITIC_TRY(const Buffer staging,
              staging_buffer(device, "readback staging", size, MemoryUse::kReadback));
  NERITIC_TRY_STATUS(run_once(device, [&](VkCommandBuffer commands) {
    transition(commands, image, anything(layout), kCopySource, mip, 1, layer, 1);
    VkBufferImageCopy region{};
    region.imageSubresource = {copy_aspect(image), mip, layer, 1};
    region.imageExtent = extent;
    vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           staging.handle(), 1, &region);
    transition(commands, image, kCopySource, anything(layout), mip, 1, layer, 1);
    VkMemoryBarrier2 to_host{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    to_host.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    to_host.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    to_host.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    to_host.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &to_host;
    vkCmdPipelineBarrier2(commands, &info);
  }));
  const auto mapped = staging.mapped<const std::byte>();
  return std::vector<std::byte>(mapped.begin(), mapped.begin() + static_cast<std::ptrdiff_t>(size));
}

}  // namespace neritic::gpu
