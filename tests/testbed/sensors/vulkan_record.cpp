#include "tests/testbed/sensors/vulkan_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string_view>

namespace neritic::test {
namespace {

VulkanRecord* recording = nullptr;  // functions of Vulkan's table have no user data

template <class Handle>
void note(VkResult result, VkObjectType type, const Handle* handles, std::uint32_t count = 1) {
  for (std::uint32_t i = 0; result == VK_SUCCESS && i < count; ++i)
    recording->note_made(type, reinterpret_cast<std::uint64_t>(handles[i]));
}

// Stands in for one function of the table, whatever its arguments before the handles are.
template <auto& slot, VkObjectType type, class Function>
struct StandIn;

template <auto& slot, VkObjectType type, class Owner, class Info, class Handle>
struct StandIn<slot, type,
               VkResult (*)(Owner, const Info*, const VkAllocationCallbacks*, Handle*)> {
  static inline std::remove_reference_t<decltype(slot)> real = nullptr;
  static VKAPI_ATTR VkResult VKAPI_CALL call(Owner owner, const Info* info,
                                             const VkAllocationCallbacks* callbacks,
                                             Handle* handle) {
    const VkResult result = real(owner, info, callbacks, handle);
    note(result, type, handle);
    if constexpr (type == VK_OBJECT_TYPE_IMAGE)
      if (result == VK_SUCCESS) recording->note_image({info->format, info->usage});
    return result;
  }
};

template <auto& slot, VkObjectType type, class Info>
struct StandIn<slot, type,
               VkResult (*)(VkDevice, VkPipelineCache, std::uint32_t, const Info*,
                            const VkAllocationCallbacks*, VkPipeline*)> {
  static inline std::remove_reference_t<decltype(slot)> real = nullptr;
  static VKAPI_ATTR VkResult VKAPI_CALL call(VkDevice device, VkPipelineCache cache,
                                             std::uint32_t count, const Info* infos,
                                             const VkAllocationCallbacks* callbacks,
                                             VkPipeline* pipelines) {
    const VkResult result = real(device, cache, count, infos, callbacks, pipelines);
    note(result, type, pipelines, count);
    return result;
  }
};

template <auto& slot, VkObjectType type, class Info, class Handle>
struct StandIn<slot, type, VkResult (*)(VkDevice, const Info*, Handle*)> {
  static inline std::remove_reference_t<decltype(slot)> real = nullptr;
  static VKAPI_ATTR VkResult VKAPI_CALL call(VkDevice device, const Info* info, Handle* handles) {
    const VkResult result = real(device, info, handles);
    if constexpr (type == VK_OBJECT_TYPE_COMMAND_BUFFER)
      note(result, type, handles, info->commandBufferCount);
    else
      note(result, type, handles, info->descriptorSetCount);
    return result;
  }
};

PFN_vkGetInstanceProcAddr real_address = nullptr;
PFN_vkSetDebugUtilsObjectNameEXT real_set_name = nullptr;

VKAPI_ATTR VkResult VKAPI_CALL set_name(VkDevice device,
                                        const VkDebugUtilsObjectNameInfoEXT* info) {
  if (recording) recording->note_named(info->objectType, info->objectHandle, info->pObjectName);
  return real_set_name(device, info);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL address(VkInstance instance, const char* name) {
  const PFN_vkVoidFunction found = real_address(instance, name);
  if (!found || std::string_view(name) != "vkSetDebugUtilsObjectNameEXT") return found;
  real_set_name = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(found);
  return reinterpret_cast<PFN_vkVoidFunction>(set_name);
}

template <auto& slot, VkObjectType type>
void replace(bool in) {
  using S = StandIn<slot, type, std::remove_reference_t<decltype(slot)>>;
  if (in)
    S::real = std::exchange(slot, S::call);
  else
    slot = S::real;
}

void replace_all(bool in) {
  replace<vkCreateDevice, VK_OBJECT_TYPE_DEVICE>(in);
  replace<vkAllocateMemory, VK_OBJECT_TYPE_DEVICE_MEMORY>(in);
  replace<vkCreateBuffer, VK_OBJECT_TYPE_BUFFER>(in);
  replace<vkCreateImage, VK_OBJECT_TYPE_IMAGE>(in);
  replace<vkCreateImageView, VK_OBJECT_TYPE_IMAGE_VIEW>(in);
  replace<vkCreateSampler, VK_OBJECT_TYPE_SAMPLER>(in);
  replace<vkCreateShaderModule, VK_OBJECT_TYPE_SHADER_MODULE>(in);
  replace<vkCreatePipelineLayout, VK_OBJECT_TYPE_PIPELINE_LAYOUT>(in);
  replace<vkCreatePipelineCache, VK_OBJECT_TYPE_PIPELINE_CACHE>(in);
  replace<vkCreateGraphicsPipelines, VK_OBJECT_TYPE_PIPELINE>(in);
  replace<vkCreateComputePipelines, VK_OBJECT_TYPE_PIPELINE>(in);
  replace<vkCreateDescriptorSetLayout, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT>(in);
  replace<vkCreateDescriptorPool, VK_OBJECT_TYPE_DESCRIPTOR_POOL>(in);
  replace<vkAllocateDescriptorSets, VK_OBJECT_TYPE_DESCRIPTOR_SET>(in);
  replace<vkCreateCommandPool, VK_OBJECT_TYPE_COMMAND_POOL>(in);
  replace<vkAllocateCommandBuffers, VK_OBJECT_TYPE_COMMAND_BUFFER>(in);
  replace<vkCreateFence, VK_OBJECT_TYPE_FENCE>(in);
  replace<vkCreateSemaphore, VK_OBJECT_TYPE_SEMAPHORE>(in);
  replace<vkCreateQueryPool, VK_OBJECT_TYPE_QUERY_POOL>(in);
}

}  // namespace

VulkanRecord::VulkanRecord() {
  recording = this;
  real_address = std::exchange(vkGetInstanceProcAddr, address);
  replace_all(true);
}

VulkanRecord::~VulkanRecord() {
  replace_all(false);
  vkGetInstanceProcAddr = real_address;
  recording = nullptr;
}

std::vector<std::string> VulkanRecord::unnamed() const {
  std::vector<std::string> out;
  for (const Made& made : made_)
    if (made.name.empty())
      out.push_back(fmt::format("object type {}, {:#x}", static_cast<int>(made.type), made.handle));
  return out;
}

std::size_t VulkanRecord::made(VkObjectType type) const {
  return static_cast<std::size_t>(std::count_if(
      made_.begin(), made_.end(), [type](const Made& made) { return made.type == type; }));
}

void VulkanRecord::note_made(VkObjectType type, std::uint64_t handle) {
  newest_[{type, handle}] = made_.size();
  made_.push_back({type, handle, {}});
}

void VulkanRecord::note_named(VkObjectType type, std::uint64_t handle, const char* name) {
  if (const auto at = newest_.find({type, handle}); at != newest_.end())
    made_[at->second].name = name;
}

}  // namespace neritic::test
