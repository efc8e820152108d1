// Inside engine/gpu only: what a physical device is and has, and the features Neritic turns on.
// Rendering thread.
#pragma once

#include <volk.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"

namespace neritic::gpu {

// The chain of feature structs; not copyable, since it points into itself.
struct FeatureChain {
  FeatureChain();
  FeatureChain(const FeatureChain&) = delete;
  FeatureChain& operator=(const FeatureChain&) = delete;
  VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
};

// Fills wanted with every required feature and those optional ones that the device has.
void select_features(VkPhysicalDevice device, FeatureChain& wanted);

// The first queue family with graphics and compute; count of families if there is none.
struct QueueChoice {
  bool found = false;
  std::uint32_t family = 0;
  std::uint32_t timestamp_valid_bits = 0;
};
QueueChoice choose_queue(VkPhysicalDevice device);

bool has_device_extension(VkPhysicalDevice device, const char* name);

DeviceInfo describe(VkPhysicalDevice device, std::uint32_t index);

Result<std::vector<VkPhysicalDevice>> physical_devices(VkInstance instance);

}  // namespace neritic::gpu
