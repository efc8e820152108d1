// XR_KHR_vulkan_enable2: the client's Vulkan instance and device, made by the runtime.
#include <fmt/format.h>

#include <cstring>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

Instance& checked(Call& call, XrInstance handle, XrSystemId system) {
  Instance& instance = call.get<Instance>(handle);
  call.require(instance.has_system && system == kSystem, XR_ERROR_SYSTEM_INVALID,
               "the system was not got by xrGetSystem");
  return instance;
}

XrResult requirements(Call& call, XrInstance handle, XrSystemId system,
                      XrGraphicsRequirementsVulkanKHR* to) {
  Instance& instance = checked(call, handle, system);
  call.out(to);
  to->minApiVersionSupported = XR_MAKE_VERSION(1, 0, 0);
  to->maxApiVersionSupported = XR_MAKE_VERSION(1, 3, 0);
  instance.asked_requirements = true;
  return XR_SUCCESS;
}

XrResult create_vulkan_instance(Call& call, XrInstance handle,
                                const XrVulkanInstanceCreateInfoKHR* create, VkInstance* made,
                                VkResult* result) {
  const auto& info = call.in(create);
  Instance& instance = checked(call, handle, info.systemId);
  call.require(instance.asked_requirements, XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING,
               "xrGetVulkanGraphicsRequirements2KHR was not called before");
  call.require(info.createFlags == 0, XR_ERROR_VALIDATION_FAILURE, "createFlags is not 0");
  call.require(info.pfnGetInstanceProcAddr, XR_ERROR_VALIDATION_FAILURE,
               "pfnGetInstanceProcAddr is a null pointer");
  call.not_null(info.vulkanCreateInfo, "vulkanCreateInfo");
  call.not_null(made, "vulkanInstance");
  call.not_null(result, "vulkanResult");
  VulkanObjects objects;
  objects.get = info.pfnGetInstanceProcAddr;
  const auto create_vk =
      reinterpret_cast<PFN_vkCreateInstance>(objects.get(VK_NULL_HANDLE, "vkCreateInstance"));
  *result = create_vk(info.vulkanCreateInfo, info.vulkanAllocator, made);
  if (*result != VK_SUCCESS) return XR_SUCCESS;  // vulkanResult tells
  objects.instance = *made;
  for (std::uint32_t i = 0; i < info.vulkanCreateInfo->enabledExtensionCount; ++i) {
    objects.debug_utils |= std::strcmp(info.vulkanCreateInfo->ppEnabledExtensionNames[i],
                                       VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0;
  }
  instance.vulkan = objects;
  return XR_SUCCESS;
}

XrResult graphics_device(Call& call, XrInstance handle, const XrVulkanGraphicsDeviceGetInfoKHR* get,
                         VkPhysicalDevice* to) {
  const auto& info = call.in(get);
  Instance& instance = checked(call, handle, info.systemId);
  VulkanObjects& vulkan = instance.vulkan;
  call.require(info.vulkanInstance && info.vulkanInstance == vulkan.instance,
               XR_ERROR_VALIDATION_FAILURE,
               "vulkanInstance is not the one that xrCreateVulkanInstanceKHR made");
  const auto enumerate = reinterpret_cast<PFN_vkEnumeratePhysicalDevices>(
      vulkan.get(vulkan.instance, "vkEnumeratePhysicalDevices"));
  std::uint32_t count = 1;
  if (enumerate(vulkan.instance, &count, &vulkan.physical) < 0 || count == 0) {
    return XR_ERROR_RUNTIME_FAILURE;
  }
  *call.not_null(to, "vulkanPhysicalDevice") = vulkan.physical;
  return XR_SUCCESS;
}

XrResult create_vulkan_device(Call& call, XrInstance handle,
                              const XrVulkanDeviceCreateInfoKHR* create, VkDevice* made,
                              VkResult* result) {
  const auto& info = call.in(create);
  Instance& instance = checked(call, handle, info.systemId);
  VulkanObjects& vulkan = instance.vulkan;
  call.require(info.createFlags == 0, XR_ERROR_VALIDATION_FAILURE, "createFlags is not 0");
  call.require(vulkan.physical && info.vulkanPhysicalDevice == vulkan.physical,
               XR_ERROR_VALIDATION_FAILURE,
               "vulkanPhysicalDevice is not the one that xrGetVulkanGraphicsDevice2KHR gave");
  call.require(info.pfnGetInstanceProcAddr, XR_ERROR_VALIDATION_FAILURE,
               "pfnGetInstanceProcAddr is a null pointer");
  call.not_null(info.vulkanCreateInfo, "vulkanCreateInfo");
  call.not_null(made, "vulkanDevice");
  call.not_null(result, "vulkanResult");
  const auto create_vk =
      reinterpret_cast<PFN_vkCreateDevice>(vulkan.get(vulkan.instance, "vkCreateDevice"));
  *result = create_vk(vulkan.physical, info.vulkanCreateInfo, info.vulkanAllocator, made);
  if (*result != VK_SUCCESS) return XR_SUCCESS;
  vulkan.device = *made;
  vulkan.queue_families.clear();
  for (std::uint32_t i = 0; i < info.vulkanCreateInfo->queueCreateInfoCount; ++i) {
    vulkan.queue_families.push_back(info.vulkanCreateInfo->pQueueCreateInfos[i].queueFamilyIndex);
  }
  return XR_SUCCESS;
}

}  // namespace

void add_vulkan_functions(Table& table) {
  const char* extension = XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME;
  table.insert(table.end(),
               {NERITIC_XR_ROW(xrGetVulkanGraphicsRequirements2KHR, requirements, extension),
                NERITIC_XR_ROW(xrCreateVulkanInstanceKHR, create_vulkan_instance, extension),
                NERITIC_XR_ROW(xrGetVulkanGraphicsDevice2KHR, graphics_device, extension),
                NERITIC_XR_ROW(xrCreateVulkanDeviceKHR, create_vulkan_device, extension)});
}

}  // namespace neritic::fakes
