// The client's Vulkan instance and device: made by the runtime (XR_KHR_vulkan_enable2), or by the
// client with the extensions that the runtime names (XR_KHR_vulkan_enable).
#include <fmt/format.h>

#include <algorithm>
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

void put_requirements(Call& call, XrGraphicsRequirementsVulkanKHR* to) {
  call.out(to);
  to->minApiVersionSupported = XR_MAKE_VERSION(1, 0, 0);
  to->maxApiVersionSupported = XR_MAKE_VERSION(1, 3, 0);
}

XrResult requirements(Call& call, XrInstance handle, XrSystemId system,
                      XrGraphicsRequirementsVulkanKHR* to) {
  Instance& instance = checked(call, handle, system);
  put_requirements(call, to);
  instance.asked_requirements = true;
  return XR_SUCCESS;
}

XrResult requirements2(Call& call, XrInstance handle, XrSystemId system,
                       XrGraphicsRequirementsVulkanKHR* to) {
  Instance& instance = checked(call, handle, system);
  put_requirements(call, to);
  instance.asked_requirements2 = true;
  return XR_SUCCESS;
}

std::set<std::string> names_of(std::uint32_t count, const char* const* names) {
  return {names, names + count};
}

// One text with a blank between two names.
XrResult put_names(Call& call, const std::set<std::string>& names, std::uint32_t capacity,
                   std::uint32_t* count, char* to) {
  std::string text = fmt::format("{}", fmt::join(names, " "));
  text.push_back('\0');
  call.fill(capacity, count, to, text);
  return XR_SUCCESS;
}

XrResult instance_extensions(Call& call, XrInstance handle, XrSystemId system,
                             std::uint32_t capacity, std::uint32_t* count, char* to) {
  checked(call, handle, system);
  return put_names(call, call.rt.script.vulkan_instance, capacity, count, to);
}

XrResult device_extensions(Call& call, XrInstance handle, XrSystemId system, std::uint32_t capacity,
                           std::uint32_t* count, char* to) {
  checked(call, handle, system);
  return put_names(call, call.rt.script.vulkan_device, capacity, count, to);
}

std::string missing(const std::set<std::string>& wanted, const std::set<std::string>& enabled) {
  std::vector<std::string> out;
  std::ranges::set_difference(wanted, enabled, std::back_inserter(out));
  return fmt::format("{}", fmt::join(out, ", "));
}

// Any instance that has the extensions. The fake knows those of instances that were made through
// it in this process; of others it has no functions.
XrResult graphics_device1(Call& call, XrInstance handle, XrSystemId system, VkInstance vulkan,
                          VkPhysicalDevice* to) {
  Instance& instance = checked(call, handle, system);
  call.not_null(to, "vkPhysicalDevice");
  call.require(vulkan, XR_ERROR_VALIDATION_FAILURE, "vkInstance is a null pointer");
  const auto& made = call.rt.made_vulkan;
  const auto known = std::find_if(made.rbegin(), made.rend(),
                                  [&](const VulkanObjects& one) { return one.instance == vulkan; });
  call.require(known != made.rend(), XR_ERROR_VALIDATION_FAILURE,
               "vkInstance is none that this process made by xrCreateVulkanInstanceKHR; the fake "
               "knows no other");
  const std::string lacks = missing(call.rt.script.vulkan_instance, known->instance_extensions);
  call.require(lacks.empty(), XR_ERROR_VALIDATION_FAILURE,
               "vkInstance lacks " + lacks + " of xrGetVulkanInstanceExtensionsKHR");
  instance.vulkan = *known;
  instance.vulkan.by_client = true;
  std::uint32_t count = 1;
  const auto enumerate = reinterpret_cast<PFN_vkEnumeratePhysicalDevices>(
      known->get(vulkan, "vkEnumeratePhysicalDevices"));
  if (enumerate(vulkan, &count, &instance.vulkan.physical) < 0 || count == 0)
    return XR_ERROR_RUNTIME_FAILURE;
  *to = instance.vulkan.physical;
  return XR_SUCCESS;
}

XrResult create_vulkan_instance(Call& call, XrInstance handle,
                                const XrVulkanInstanceCreateInfoKHR* create, VkInstance* made,
                                VkResult* result) {
  const auto& info = call.in(create);
  Instance& instance = checked(call, handle, info.systemId);
  call.require(instance.asked_requirements2, XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING,
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
  objects.instance_extensions = names_of(info.vulkanCreateInfo->enabledExtensionCount,
                                         info.vulkanCreateInfo->ppEnabledExtensionNames);
  instance.vulkan = objects;
  call.rt.made_vulkan.push_back(objects);
  return XR_SUCCESS;
}

XrResult graphics_device(Call& call, XrInstance handle, const XrVulkanGraphicsDeviceGetInfoKHR* get,
                         VkPhysicalDevice* to) {
  const auto& info = call.in(get);
  Instance& instance = checked(call, handle, info.systemId);
  VulkanObjects& vulkan = instance.vulkan;
  call.require(info.vulkanInstance && info.vulkanInstance == vulkan.instance && !vulkan.by_client,
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
  vulkan.device_extensions = names_of(info.vulkanCreateInfo->enabledExtensionCount,
                                      info.vulkanCreateInfo->ppEnabledExtensionNames);
  call.rt.made_vulkan.push_back(vulkan);
  return XR_SUCCESS;
}

}  // namespace

void add_vulkan_functions(Table& table) {
  const char* extension = XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME;
  const char* first = XR_KHR_VULKAN_ENABLE_EXTENSION_NAME;
  table.insert(table.end(),
               {NERITIC_XR_ROW(xrGetVulkanGraphicsRequirementsKHR, requirements, first),
                NERITIC_XR_ROW(xrGetVulkanInstanceExtensionsKHR, instance_extensions, first),
                NERITIC_XR_ROW(xrGetVulkanDeviceExtensionsKHR, device_extensions, first),
                NERITIC_XR_ROW(xrGetVulkanGraphicsDeviceKHR, graphics_device1, first),
                NERITIC_XR_ROW(xrGetVulkanGraphicsRequirements2KHR, requirements2, extension),
                NERITIC_XR_ROW(xrCreateVulkanInstanceKHR, create_vulkan_instance, extension),
                NERITIC_XR_ROW(xrGetVulkanGraphicsDevice2KHR, graphics_device, extension),
                NERITIC_XR_ROW(xrCreateVulkanDeviceKHR, create_vulkan_device, extension)});
}

}  // namespace neritic::fakes
