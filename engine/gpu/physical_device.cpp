#include "engine/gpu/physical_device.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/gpu/device_select.hpp"
#include "engine/gpu/error.hpp"
#include "engine/gpu/needed_formats.hpp"
#include "engine/gpu/needed_limits.hpp"

namespace neritic::gpu {
namespace {

template <class Struct>
struct FeatureRow {
  VkBool32 Struct::*member;
  const char* name;
};

// Required beyond Vulkan 1.3: what the engine is built on.
constexpr std::array kRequired{
    FeatureRow<VkPhysicalDeviceFeatures>{
        &VkPhysicalDeviceFeatures::shaderStorageImageExtendedFormats,  // rg32f, in sonar shaders
        "shaderStorageImageExtendedFormats"},
};
constexpr std::array kRequired11{
    FeatureRow<VkPhysicalDeviceVulkan11Features>{&VkPhysicalDeviceVulkan11Features::multiview,
                                                 "multiview"},
};
constexpr std::array kRequired12{
    FeatureRow<VkPhysicalDeviceVulkan12Features>{
        &VkPhysicalDeviceVulkan12Features::timelineSemaphore, "timelineSemaphore"},
    FeatureRow<VkPhysicalDeviceVulkan12Features>{
        &VkPhysicalDeviceVulkan12Features::scalarBlockLayout, "scalarBlockLayout"},
    FeatureRow<VkPhysicalDeviceVulkan12Features>{&VkPhysicalDeviceVulkan12Features::hostQueryReset,
                                                 "hostQueryReset"},
};
constexpr std::array kRequired13{
    FeatureRow<VkPhysicalDeviceVulkan13Features>{
        &VkPhysicalDeviceVulkan13Features::dynamicRendering, "dynamicRendering"},
    FeatureRow<VkPhysicalDeviceVulkan13Features>{
        &VkPhysicalDeviceVulkan13Features::synchronization2, "synchronization2"},
    // A texel fetched outside an image is zero, so that shaders need no bounds checks.
    FeatureRow<VkPhysicalDeviceVulkan13Features>{
        &VkPhysicalDeviceVulkan13Features::robustImageAccess, "robustImageAccess"},
    FeatureRow<VkPhysicalDeviceVulkan13Features>{&VkPhysicalDeviceVulkan13Features::maintenance4,
                                                 "maintenance4"},
};

// Enabled if the device has them: code that uses one checks Device::features(), or the limit that
// it raises (maxDrawIndexedIndexValue).
constexpr std::array kOptional{
    &VkPhysicalDeviceFeatures::independentBlend, &VkPhysicalDeviceFeatures::fullDrawIndexUint32,
    &VkPhysicalDeviceFeatures::dualSrcBlend,        // of tinted glass
    &VkPhysicalDeviceFeatures::shaderClipDistance,  // of what a mirror shows, for sonars' ghosts
};

// Adds the names of the required features that have lacks, comma-separated.
template <class Struct, std::size_t N>
void add_missing(const Struct& have, const std::array<FeatureRow<Struct>, N>& rows,
                 std::string& missing) {
  for (const auto& row : rows)
    if (!(have.*row.member)) missing += (missing.empty() ? "" : ", ") + std::string(row.name);
}

template <class Struct, std::size_t N>
void require(Struct& wanted, const std::array<FeatureRow<Struct>, N>& rows) {
  for (const auto& row : rows) wanted.*row.member = VK_TRUE;
}

// Shaders pass numbers from lane to lane (shaders/shared/even.glsl).
bool has_subgroups(VkPhysicalDevice device) {
  VkPhysicalDeviceVulkan11Properties have{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &have};
  vkGetPhysicalDeviceProperties2(device, &all);
  constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
  constexpr VkSubgroupFeatureFlags kOperations =
      VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
      VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
  return (have.subgroupSupportedStages & kStages) == kStages &&
         (have.subgroupSupportedOperations & kOperations) == kOperations;
}

std::string missing_of(VkPhysicalDevice device, const VkPhysicalDeviceProperties& properties) {
  if (properties.apiVersion < VK_API_VERSION_1_3)
    return fmt::format("Vulkan 1.3 (it has {}.{})", VK_API_VERSION_MAJOR(properties.apiVersion),
                       VK_API_VERSION_MINOR(properties.apiVersion));
  std::string missing;
  FeatureChain have;
  vkGetPhysicalDeviceFeatures2(device, &have.core);
  add_missing(have.core.features, kRequired, missing);
  add_missing(have.v11, kRequired11, missing);
  add_missing(have.v12, kRequired12, missing);
  add_missing(have.v13, kRequired13, missing);
  const auto add = [&missing](const std::string& what) {
    if (!what.empty()) missing += (missing.empty() ? "" : ", ") + what;
  };
  if (!has_subgroups(device)) add("shuffles of subgroups in compute and fragment shaders");
  if (!choose_queue(device).found) add("a queue with graphics and compute");
  add(missing_limits(properties.limits));
  add(missing_formats([device](VkFormat format) {
    VkFormatProperties properties_of_format{};
    vkGetPhysicalDeviceFormatProperties(device, format, &properties_of_format);
    return properties_of_format.optimalTilingFeatures;
  }));
  return missing;
}

void describe_memory(VkPhysicalDevice device, DeviceInfo& info) {
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(device, &memory);
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      info.memory_bytes += memory.memoryHeaps[i].size;
  info.shared_memory = true;
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (!(memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT))
      info.shared_memory = false;
}

}  // namespace

FeatureChain::FeatureChain() {
  core.pNext = &v11;
  v11.pNext = &v12;
  v12.pNext = &v13;
}

void select_features(VkPhysicalDevice device, FeatureChain& wanted) {
  FeatureChain have;
  vkGetPhysicalDeviceFeatures2(device, &have.core);
  for (const auto feature : kOptional) wanted.core.features.*feature = have.core.features.*feature;
  require(wanted.core.features, kRequired);
  require(wanted.v11, kRequired11);
  require(wanted.v12, kRequired12);
  require(wanted.v13, kRequired13);
}

QueueChoice choose_queue(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (std::uint32_t i = 0; i < count; ++i)
    if ((families[i].queueFlags & kNeeded) == kNeeded)
      return {true, i, families[i].timestampValidBits};
  return {};
}

bool has_device_extension(VkPhysicalDevice device, const char* name) {
  std::uint32_t count = 0;
  if (vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr) != VK_SUCCESS)
    return false;
  std::vector<VkExtensionProperties> extensions(count);
  if (vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()) < VK_SUCCESS)
    return false;
  extensions.resize(count);
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

DeviceInfo describe(VkPhysicalDevice device, std::uint32_t index) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(device, &properties);
  DeviceInfo info;
  info.name = properties.deviceName;
  info.kind = device_kind_name(properties.deviceType);
  info.index = index;
  info.api_version = properties.apiVersion;
  info.max_image_size = properties.limits.maxImageDimension2D;
  info.timestamps = choose_queue(device).timestamp_valid_bits > 0;
  info.can_present = has_device_extension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  describe_memory(device, info);
  info.missing = missing_of(device, properties);
  info.usable = info.missing.empty();
  if (properties.apiVersion >= VK_API_VERSION_1_2) {
    VkPhysicalDeviceMultiviewProperties multiview{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_PROPERTIES};
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
                                            &multiview};
    VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
    vkGetPhysicalDeviceProperties2(device, &all);
    info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    info.max_views = multiview.maxMultiviewViewCount;
    info.quirks = quirks_of(driver.driverID, driver.driverInfo);
  }
  return info;
}

Result<std::vector<VkPhysicalDevice>> physical_devices(VkInstance instance) {
  std::uint32_t count = 0;
  VkResult result = vkEnumeratePhysicalDevices(instance, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  if (result == VK_SUCCESS && count > 0)
    result = vkEnumeratePhysicalDevices(instance, &count, devices.data());
  // No driver can report itself as a failed initialization.
  if (result == VK_ERROR_INITIALIZATION_FAILED)
    count = 0;
  else if (result < VK_SUCCESS)
    return vulkan_error(result, "vkEnumeratePhysicalDevices");
  devices.resize(count);
  if (devices.empty()) return no_device();
  return devices;
}

}  // namespace neritic::gpu
