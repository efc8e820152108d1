// Inside engine/gpu only: the pipeline cache's file. Its name holds the device's identity, its
// content a checksum: what is damaged or from another driver is as good as absent. Rendering
// thread.
#pragma once

#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::gpu {

std::filesystem::path pipeline_cache_file(const std::filesystem::path& folder,
                                          VkPhysicalDevice device);

// The driver's data in the file's bytes; empty where the file is not ours, damaged, or its Vulkan
// header names another device than properties.
std::vector<std::byte> unpack_cache(std::span<const std::byte> file,
                                    const VkPhysicalDeviceProperties& properties);
std::vector<std::byte> pack_cache(std::span<const std::byte> data);

}  // namespace neritic::gpu
