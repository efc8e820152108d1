// Whether a test that needs a Vulkan device may be skipped.
#pragma once

#include <cstdlib>
#include <string>

#include "engine/gpu/device.hpp"

namespace neritic::test {

inline bool device_is_required() {
  const char* required = std::getenv("NERITIC_REQUIRE_DEVICE");
  return required && std::string(required) == "1";
}

// True only where nothing is there to test on (no device, or no validation layer), and none is
// required.
inline bool may_skip_without_device() {
  if (device_is_required()) return false;
  const auto devices = gpu::list_devices();
  const bool none = devices.ok() ? devices->empty() : devices.error().code == ErrorCode::kNoDevice;
  return none || !gpu::validation_layer_present();
}

}  // namespace neritic::test
