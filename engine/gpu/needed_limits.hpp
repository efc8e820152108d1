// The limits that Neritic's passes need beyond those that Vulkan 1.3 promises of every device. A
// device that stays below one is not chosen, and `doctor` says which. Pure; any thread.
#pragma once

#include <volk.h>

#include <string>

namespace neritic::gpu {

// "maxColorAttachments of 6 (it has 4), ..."; empty where the limits are enough.
std::string missing_limits(const VkPhysicalDeviceLimits& have);

}  // namespace neritic::gpu
