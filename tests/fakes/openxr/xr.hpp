// The OpenXR and Vulkan headers as the fake runtime uses them, and names of their enumerations.
#pragma once

#include <time.h>
#include <vulkan/vulkan.h>

#define XR_NO_PROTOTYPES
#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>
#include <openxr/openxr_reflection.h>

#include <string>

namespace neritic::fakes {

// The structure type that a structure must state: kType<XrFrameEndInfo>.
template <class T>
inline constexpr XrStructureType kType = XR_TYPE_UNKNOWN;
#define NERITIC_XR_TYPE(structure, value) \
  template <>                             \
  inline constexpr XrStructureType kType<structure> = value;
XR_LIST_STRUCTURE_TYPES_CORE(NERITIC_XR_TYPE)
XR_LIST_STRUCTURE_TYPES_XR_USE_GRAPHICS_API_VULKAN(NERITIC_XR_TYPE)
#undef NERITIC_XR_TYPE

std::string name_of(XrStructureType value);
std::string name_of(XrResult value);
std::string name_of(XrSessionState value);
std::string name_of(XrObjectType value);
std::string name_of(XrViewConfigurationType value);

}  // namespace neritic::fakes
