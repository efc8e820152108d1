// Chooses the device to run on: a pure function on plain data, tested without a GPU. Any thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"

namespace neritic::gpu {

// The names DeviceInfo::kind can have.
const char* device_kind_name(VkPhysicalDeviceType type);

// Nothing to choose from: which package brings a device, and why an installed one may not show.
Error no_device();

// The position in devices to use. wanted: empty (the first usable of discrete, integrated, virtual,
// CPU, other), an index as listed, or a part of a name in any case (a number that is no index is
// looked for in the names). kNoDevice lists what there is; kUnsupported says what the named device
// lacks.
Result<std::uint32_t> choose_device(std::span<const DeviceInfo> devices, const std::string& wanted);

// "0: NVIDIA H200 (discrete GPU); 1: llvmpipe (CPU)".
std::string device_names(std::span<const DeviceInfo> devices);

}  // namespace neritic::gpu
