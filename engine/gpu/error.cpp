#include "engine/gpu/error.hpp"

namespace neritic::gpu {
namespace {

const char* result_name(VkResult result) {
#define NERITIC_CASE(value) \
  case value:               \
    return #value
  switch (result) {
    NERITIC_CASE(VK_SUCCESS);
    NERITIC_CASE(VK_NOT_READY);
    NERITIC_CASE(VK_TIMEOUT);
    NERITIC_CASE(VK_INCOMPLETE);
    NERITIC_CASE(VK_ERROR_OUT_OF_HOST_MEMORY);
    NERITIC_CASE(VK_ERROR_OUT_OF_DEVICE_MEMORY);
    NERITIC_CASE(VK_ERROR_INITIALIZATION_FAILED);
    NERITIC_CASE(VK_ERROR_DEVICE_LOST);
    NERITIC_CASE(VK_ERROR_MEMORY_MAP_FAILED);
    NERITIC_CASE(VK_ERROR_LAYER_NOT_PRESENT);
    NERITIC_CASE(VK_ERROR_EXTENSION_NOT_PRESENT);
    NERITIC_CASE(VK_ERROR_FEATURE_NOT_PRESENT);
    NERITIC_CASE(VK_ERROR_INCOMPATIBLE_DRIVER);
    NERITIC_CASE(VK_ERROR_TOO_MANY_OBJECTS);
    NERITIC_CASE(VK_ERROR_FORMAT_NOT_SUPPORTED);
    NERITIC_CASE(VK_ERROR_FRAGMENTED_POOL);
    NERITIC_CASE(VK_ERROR_OUT_OF_POOL_MEMORY);
    NERITIC_CASE(VK_ERROR_FRAGMENTATION);
    NERITIC_CASE(VK_ERROR_SURFACE_LOST_KHR);
    NERITIC_CASE(VK_ERROR_NATIVE_WINDOW_IN_USE_KHR);
    NERITIC_CASE(VK_ERROR_OUT_OF_DATE_KHR);
    default:
      return nullptr;
  }
#undef NERITIC_CASE
}

ErrorCode code_of(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_MEMORY_MAP_FAILED:
    case VK_ERROR_TOO_MANY_OBJECTS:
    case VK_ERROR_FRAGMENTED_POOL:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_FRAGMENTATION:
      return ErrorCode::kOutOfMemory;
    case VK_ERROR_DEVICE_LOST:
    case VK_TIMEOUT:
      return ErrorCode::kDeviceLost;
    case VK_ERROR_INCOMPATIBLE_DRIVER:
    case VK_ERROR_INITIALIZATION_FAILED:
      return ErrorCode::kNoDevice;
    default:
      return ErrorCode::kUnsupported;
  }
}

}  // namespace

Error vulkan_error(VkResult result, const std::string& what) {
  const char* name = result_name(result);
  return {code_of(result), name ? fmt::format("{}: {}", what, name)
                                : fmt::format("{}: VkResult {}", what, static_cast<int>(result))};
}

}  // namespace neritic::gpu
