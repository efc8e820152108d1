// Inside engine/gpu only: the Vulkan loader, the instance and the validation messenger.
// Rendering thread.
#pragma once

#include <volk.h>

#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"

namespace neritic::gpu {

// Where the messenger's messages go; must outlive the instance.
struct ValidationTarget {
  ValidationLog* log = nullptr;   // the Device's own; nullptr once it is being destroyed
  ValidationLog* sink = nullptr;  // the program's, or nullptr
};

struct InstanceHandles {
  VkInstance instance = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;  // only with validation
  bool debug_utils = false;
};

// Loads the loader (once a process) and makes an instance of Vulkan 1.3. kNoDevice where there is
// no loader or no driver; kUnsupported where validation is asked for and its layer is absent.
Result<InstanceHandles> create_instance(const DeviceOptions& options, ValidationTarget* target);
void destroy_instance(const InstanceHandles& handles);

}  // namespace neritic::gpu
