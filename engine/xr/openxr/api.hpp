// Inside engine/xr/openxr only: OpenXR's headers, its functions as a table that is read from the
// loader while the program runs (so that a machine without a loader runs everything else), and
// conversions. Plain values; any thread.
#pragma once

#include <time.h>
#include <volk.h>

#define XR_NO_PROTOTYPES
#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <string>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::xr::openxr {

// Functions of OpenXR 1.0 and XR_KHR_vulkan_enable2.
#define NERITIC_XR_FUNCTIONS(X)        \
  X(DestroyInstance)                   \
  X(GetInstanceProperties)             \
  X(PollEvent)                         \
  X(ResultToString)                    \
  X(GetSystem)                         \
  X(GetSystemProperties)               \
  X(EnumerateEnvironmentBlendModes)    \
  X(CreateSession)                     \
  X(DestroySession)                    \
  X(EnumerateReferenceSpaces)          \
  X(CreateReferenceSpace)              \
  X(LocateSpace)                       \
  X(DestroySpace)                      \
  X(EnumerateViewConfigurations)       \
  X(EnumerateViewConfigurationViews)   \
  X(EnumerateSwapchainFormats)         \
  X(CreateSwapchain)                   \
  X(DestroySwapchain)                  \
  X(EnumerateSwapchainImages)          \
  X(AcquireSwapchainImage)             \
  X(WaitSwapchainImage)                \
  X(ReleaseSwapchainImage)             \
  X(BeginSession)                      \
  X(EndSession)                        \
  X(RequestExitSession)                \
  X(WaitFrame)                         \
  X(BeginFrame)                        \
  X(EndFrame)                          \
  X(LocateViews)                       \
  X(GetVulkanGraphicsRequirements2KHR) \
  X(CreateVulkanInstanceKHR)           \
  X(GetVulkanGraphicsDevice2KHR)       \
  X(CreateVulkanDeviceKHR)

// Functions of input and of extensions. A runtime may lack them: nullptr then.
#define NERITIC_XR_OPTIONAL_FUNCTIONS(X) \
  X(CreateActionSpace)                   \
  X(StringToPath)                        \
  X(CreateActionSet)                     \
  X(DestroyActionSet)                    \
  X(CreateAction)                        \
  X(SuggestInteractionProfileBindings)   \
  X(AttachSessionActionSets)             \
  X(GetActionStateFloat)                 \
  X(GetActionStatePose)                  \
  X(SyncActions)                         \
  X(GetVulkanGraphicsRequirementsKHR)    \
  X(GetVulkanInstanceExtensionsKHR)      \
  X(GetVulkanDeviceExtensionsKHR)        \
  X(GetVulkanGraphicsDeviceKHR)          \
  X(ConvertTimeToTimespecTimeKHR)        \
  X(EnumerateDisplayRefreshRatesFB)      \
  X(RequestDisplayRefreshRateFB)         \
  X(CreateHandTrackerEXT)                \
  X(DestroyHandTrackerEXT)               \
  X(LocateHandJointsEXT)                 \
  X(GetVisibilityMaskKHR)                \
  X(CreateDebugUtilsMessengerEXT)        \
  X(DestroyDebugUtilsMessengerEXT)

#define NERITIC_XR_MEMBER(name) PFN_xr##name name = nullptr;
struct Functions {
  NERITIC_XR_FUNCTIONS(NERITIC_XR_MEMBER)
  NERITIC_XR_OPTIONAL_FUNCTIONS(NERITIC_XR_MEMBER)
};

// Those of an instance. kUnsupported names one that the runtime should have and lacks.
Result<Functions> instance_functions(PFN_xrGetInstanceProcAddr get, XrInstance instance);

// Before there is an instance. The loader stays loaded.
struct Loader {
  PFN_xrGetInstanceProcAddr get = nullptr;
  PFN_xrEnumerateInstanceExtensionProperties extensions = nullptr;
  PFN_xrEnumerateApiLayerProperties layers = nullptr;
  PFN_xrCreateInstance create = nullptr;
};
// kNoDevice where no loader (libopenxr_loader.so.1) is installed, with the Debian package.
Result<Loader> load_loader();

// The runtime's own table of results, without an instance: "XR_ERROR_SESSION_LOST".
std::string name_of(XrResult result);

// The usual pair of calls: how many, then all of them. Items begin as `blank`. The second call may
// meet more items than the first counted.
template <class T, class Function>
XrResult enumerate(std::vector<T>& items, const T& blank, Function call) {
  for (int attempt = 0; attempt < 3; ++attempt) {
    std::uint32_t count = 0;
    XrResult result = call(0u, &count, static_cast<T*>(nullptr));
    items.assign(XR_SUCCEEDED(result) ? count : 0, blank);
    if (XR_FAILED(result) || count == 0) return result;
    result = call(count, &count, items.data());
    if (result == XR_ERROR_SIZE_INSUFFICIENT) continue;
    if (XR_FAILED(result)) count = 0;
    items.resize(count);
    return result;
  }
  return XR_ERROR_SIZE_INSUFFICIENT;
}

inline Pose to_pose(const XrPosef& p) {
  return {
      {p.position.x, p.position.y, p.position.z},
      unit_or_identity(Quat(p.orientation.w, p.orientation.x, p.orientation.y, p.orientation.z))};
}
inline XrPosef to_xr(const Pose& p) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {{f(p.rotation.x), f(p.rotation.y), f(p.rotation.z), f(p.rotation.w)},
          {f(p.position_m.x), f(p.position_m.y), f(p.position_m.z)}};
}
// Angles are to the view's edges; left and down are negative as a rule.
inline FrustumTangents to_tangents(const XrFovf& fov) {
  return {std::tan(double{fov.angleLeft}), std::tan(double{fov.angleRight}),
          std::tan(double{fov.angleDown}), std::tan(double{fov.angleUp})};
}

}  // namespace neritic::xr::openxr
