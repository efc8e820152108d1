// Messages of Vulkan's validation layers about a device's work. Rendering thread only.
#pragma once

#include "engine/gpu/device.hpp"

namespace neritic::testbed {

// Waits for the device; each message is a warning, and any of them a failure.
Status check_validation(const gpu::Device& device);

}  // namespace neritic::testbed
