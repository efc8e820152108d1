// The commands that one frame can record; Frames owns the objects behind them. Rendering thread.
#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"

namespace neritic::gpu {
namespace {

VkShaderStageFlags stages_of(const Pipeline& pipeline) {
  return pipeline.bind_point() == VK_PIPELINE_BIND_POINT_COMPUTE
             ? VK_SHADER_STAGE_COMPUTE_BIT
             : VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
}

}  // namespace

void Commands::bind_pipeline(const Pipeline& pipeline) {
  vkCmdBindPipeline(handle_, pipeline.bind_point(), pipeline.handle());
}

void Commands::bind(const Pipeline& pipeline, std::span<const BoundResource> resources) {
  const VkDescriptorSet set = frames_->frame_set(pipeline);
  if (set == VK_NULL_HANDLE) return;  // submit returns the error
  write_descriptors(frames_->device(), set, pipeline.bindings(), resources);
  vkCmdBindDescriptorSets(handle_, pipeline.bind_point(), pipeline.layout(), 0, 1, &set, 0,
                          nullptr);
}

void Commands::push_bytes(const Pipeline& pipeline, const void* data, std::uint32_t size) {
  vkCmdPushConstants(handle_, pipeline.layout(), stages_of(pipeline), 0, size, data);
}

void Commands::dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  vkCmdDispatch(handle_, x, y, z);
}

void Commands::wait_for_dispatch() {
  VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  memory.srcStageMask = memory.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  memory.srcAccessMask = VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_SHADER_READ_BIT;
  memory.dstAccessMask = VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_SHADER_READ_BIT;
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &memory;
  vkCmdPipelineBarrier2(handle_, &dependency);
}

UploadSlice Commands::upload(const void* data, VkDeviceSize size) {
  return frames_->frame_upload(data, size);
}

void Commands::begin_region(const std::string& name) {
  frames_->device().begin_label(handle_, name);
  frames_->timestamp(&name);
}

void Commands::end_region() {
  frames_->timestamp(nullptr);
  frames_->device().end_label(handle_);
}

}  // namespace neritic::gpu
