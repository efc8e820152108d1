#include "engine/xr/openxr/runtime.hpp"

#include <cstdlib>
#include <cstring>
#include <sstream>

#include "engine/core/log.hpp"

namespace neritic::xr::openxr {
namespace {

constexpr const char* kValidationLayer = "XR_APILAYER_LUNARG_core_validation";

struct Known {
  const char* name;
  const char* adds;
  bool Extensions::*flag;  // nullptr: needed
};
constexpr Known kKnown[] = {
    {XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME, "pictures by Vulkan (needed)", nullptr},
    {XR_KHR_VULKAN_ENABLE_EXTENSION_NAME, "shown again after the runtime was away",
     &Extensions::vulkan1},
    {XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME, "display times on the host's clock, exactly",
     &Extensions::timespec},
    {XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME,
     "depth with each picture: late frames are shifted with parallax", &Extensions::depth},
    {XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME, "--refresh chooses the display's rate",
     &Extensions::refresh_rate},
    {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME, "four views: two sharp ones within two wide ones",
     &Extensions::quad_views},
    {XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME, "the sharp views follow the gaze",
     &Extensions::foveated},
    {XR_EXT_HAND_TRACKING_EXTENSION_NAME, "the diver's hands follow the wearer's",
     &Extensions::hands},
    {XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME, "the wearer's gaze", &Extensions::gaze},
    {XR_KHR_COMPOSITION_LAYER_CYLINDER_EXTENSION_NAME,
     "wide instruments are bent around the wearer", &Extensions::cylinder},
    {XR_KHR_VISIBILITY_MASK_EXTENSION_NAME, "what the lenses cannot show is not drawn",
     &Extensions::mask},
    {XR_EXTX_OVERLAY_EXTENSION_NAME, "neritic hud: instruments over another program",
     &Extensions::overlay},
};

std::vector<std::string> names_of(const Loader& loader, const char* layer) {
  std::vector<XrExtensionProperties> found;
  enumerate(found, {XR_TYPE_EXTENSION_PROPERTIES}, [&](auto capacity, auto count, auto items) {
    return loader.extensions(layer, capacity, count, items);
  });
  std::vector<std::string> names;
  for (const XrExtensionProperties& extension : found) names.push_back(extension.extensionName);
  return names;
}

bool contains(const std::vector<std::string>& names, const char* name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool layer_present(const Loader& loader) {
  std::vector<XrApiLayerProperties> layers;
  enumerate(layers, {XR_TYPE_API_LAYER_PROPERTIES}, [&](auto capacity, auto count, auto items) {
    return loader.layers(capacity, count, items);
  });
  return std::any_of(layers.begin(), layers.end(), [](const XrApiLayerProperties& layer) {
    return std::strcmp(layer.layerName, kValidationLayer) == 0;
  });
}

std::vector<std::string> offered_by_vulkan(VkPhysicalDevice device = VK_NULL_HANDLE) {
  const auto ask = [&](std::uint32_t* count, VkExtensionProperties* items) {
    return device ? vkEnumerateDeviceExtensionProperties(device, nullptr, count, items)
                  : vkEnumerateInstanceExtensionProperties(nullptr, count, items);
  };
  std::uint32_t count = 0;
  if (ask(&count, nullptr) != VK_SUCCESS) return {};
  std::vector<VkExtensionProperties> found(count);
  if (ask(&count, found.data()) < VK_SUCCESS) return {};
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < count; ++i) names.push_back(found[i].extensionName);
  return names;
}

// Makes a Vulkan object with the extensions of `info` and those of the wished that are offered, or,
// where that fails, without the latter. enabled: gets what it was made with.
template <class Info, class Make>
VkResult make_with_wished(const Info& info, const Result<std::vector<std::string>>& wished,
                          const std::vector<std::string>& offered,
                          std::vector<std::string>& enabled, const Make& make) {
  const std::vector<std::string> own(info.ppEnabledExtensionNames,
                                     info.ppEnabledExtensionNames + info.enabledExtensionCount);
  enabled = own;
  if (wished.ok())
    for (const std::string& name : *wished)
      if (contains(offered, name.c_str()) && !contains(enabled, name.c_str()))
        enabled.push_back(name);
  std::vector<const char*> names;
  for (const std::string& name : enabled) names.push_back(name.c_str());
  Info with = info;
  with.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
  with.ppEnabledExtensionNames = names.data();
  const VkResult made = make(with);
  if (made == VK_SUCCESS || enabled.size() == own.size()) return made;
  enabled = own;
  return make(info);
}

XRAPI_ATTR XrBool32 XRAPI_CALL on_message(XrDebugUtilsMessageSeverityFlagsEXT,
                                          XrDebugUtilsMessageTypeFlagsEXT,
                                          const XrDebugUtilsMessengerCallbackDataEXT* data,
                                          void* user) {
  constexpr std::size_t kMost = 1000;  // a layer may speak in each frame
  auto& messages = *static_cast<std::vector<std::string>*>(user);
  if (messages.size() < kMost)
    messages.push_back(fmt::format("{}: {}", data->functionName ? data->functionName : "",
                                   data->message ? data->message : "(no message)"));
  return XR_FALSE;
}

}  // namespace

Result<std::unique_ptr<Runtime>> Runtime::create(const HeadsetOptions& options, bool system,
                                                 std::vector<std::string>* messages) {
  NERITIC_TRY(const Loader loader, load_loader());
  std::unique_ptr<Runtime> runtime(new Runtime());
  NERITIC_TRY_STATUS(runtime->create_instance(loader, options));
  if (options.validation) runtime->listen(messages);
  if (!system) return runtime;
  NERITIC_TRY_STATUS(runtime->find_system());
  NERITIC_TRY_STATUS(runtime->ask_vulkan());
  return runtime;
}

Status Runtime::create_instance(const Loader& loader, const HeadsetOptions& options) {
  const std::vector<std::string> offered = names_of(loader, nullptr);
  if (offered.empty()) {
    const char* const named = std::getenv("XR_RUNTIME_JSON");
    return failure(
        ErrorCode::kNoDevice, "{} (docs/headsets.md)",
        named && *named
            ? fmt::format("the OpenXR runtime of XR_RUNTIME_JSON={} does not load", named)
            : "no OpenXR runtime is active");
  }
  std::vector<const char*> wanted;
  for (const Known& known : kKnown) {
    // The gaze moves the sharp views of four only.
    const bool is_offered = contains(offered, known.name);
    const bool here = is_offered && (known.flag != &Extensions::foveated || has_.quad_views) &&
                      (known.flag != &Extensions::overlay || options.overlay);
    info_.extensions.push_back({known.name, known.adds, is_offered});
    if (known.flag) has_.*known.flag = here;
    if (here) wanted.push_back(known.name);
    if (!here && !known.flag)
      return failure(ErrorCode::kUnsupported, "the OpenXR runtime has no {}", known.name);
  }
  if (options.overlay && !has_.overlay)
    return failure(ErrorCode::kUnsupported,
                   "the OpenXR runtime has no {}: it shows nothing over another program",
                   XR_EXTX_OVERLAY_EXTENSION_NAME);
  for (const std::string& name : offered)
    if (std::none_of(std::begin(kKnown), std::end(kKnown),
                     [&](const Known& known) { return name == known.name; }))
      info_.others.push_back(name);
  XrInstanceCreateInfo info{XR_TYPE_INSTANCE_CREATE_INFO};
  if (options.validation) {
    if (!layer_present(loader))
      return failure(ErrorCode::kUnsupported,
                     "validation needs {}: install the Debian package openxr-layer-corevalidation",
                     kValidationLayer);
    info.enabledApiLayerCount = 1;
    info.enabledApiLayerNames = &kValidationLayer;
    // The layer or the loader brings it where the runtime does not.
    wanted.push_back(XR_EXT_DEBUG_UTILS_EXTENSION_NAME);
    has_.debug = true;
  }
  std::strncpy(info.applicationInfo.applicationName, "Neritic", XR_MAX_APPLICATION_NAME_SIZE - 1);
  std::strncpy(info.applicationInfo.engineName, "Neritic", XR_MAX_ENGINE_NAME_SIZE - 1);
  info.applicationInfo.applicationVersion = info.applicationInfo.engineVersion = 1;
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  info.enabledExtensionCount = static_cast<std::uint32_t>(wanted.size());
  info.enabledExtensionNames = wanted.data();
  const XrResult made = loader.create(&info, &instance_);
  if (XR_FAILED(made)) {
    instance_ = XR_NULL_HANDLE;
    return failure(ErrorCode::kNoDevice, "the OpenXR runtime does not start ({})", name_of(made));
  }
  (void)loader.get(instance_, "xrDestroyInstance",
                   reinterpret_cast<PFN_xrVoidFunction*>(&xr_.DestroyInstance));
  NERITIC_TRY(xr_, instance_functions(loader.get, instance_));
  XrInstanceProperties properties{XR_TYPE_INSTANCE_PROPERTIES};
  NERITIC_TRY_STATUS(
      check(xr_.GetInstanceProperties(instance_, &properties), "xrGetInstanceProperties"));
  info_.runtime = fmt::format(
      "{} {}.{}.{}", properties.runtimeName, XR_VERSION_MAJOR(properties.runtimeVersion),
      XR_VERSION_MINOR(properties.runtimeVersion), XR_VERSION_PATCH(properties.runtimeVersion));
  return {};
}

void Runtime::listen(std::vector<std::string>* messages) {
  if (!xr_.CreateDebugUtilsMessengerEXT || !messages) return;
  XrDebugUtilsMessengerCreateInfoEXT info{XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverities = XR_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageTypes = XR_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                      XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                      XR_DEBUG_UTILS_MESSAGE_TYPE_CONFORMANCE_BIT_EXT;
  info.userCallback = on_message;
  info.userData = messages;
  if (XR_FAILED(xr_.CreateDebugUtilsMessengerEXT(instance_, &info, &messenger_)))
    messenger_ = XR_NULL_HANDLE;
}

Status Runtime::find_system() {
  XrSystemGetInfo get{XR_TYPE_SYSTEM_GET_INFO};
  get.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  const XrResult found = xr_.GetSystem(instance_, &get, &system_);
  if (XR_FAILED(found)) {
    (void)check(found, "xrGetSystem");  // keeps a loss
    return failure(ErrorCode::kNoDevice, "{} has no headset now ({})", info_.runtime,
                   name_of(found));
  }
  XrSystemFoveatedRenderingPropertiesVARJO foveated{
      XR_TYPE_SYSTEM_FOVEATED_RENDERING_PROPERTIES_VARJO};
  XrSystemHandTrackingPropertiesEXT hands{XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT};
  XrSystemEyeGazeInteractionPropertiesEXT gaze{XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT};
  // One at a time: the validation layer (1.0.20) refuses a chain of two.
  const auto ask = [&](auto* part) {
    properties_.next = part;
    const Status asked =
        check(xr_.GetSystemProperties(instance_, system_, &properties_), "xrGetSystemProperties");
    properties_.next = nullptr;
    return asked;
  };
  NERITIC_TRY_STATUS(ask(static_cast<void*>(nullptr)));
  if (has_.foveated) NERITIC_TRY_STATUS(ask(&foveated));
  if (has_.hands) NERITIC_TRY_STATUS(ask(&hands));
  if (has_.gaze) NERITIC_TRY_STATUS(ask(&gaze));
  info_.system = properties_.systemName;
  foveation_here_ = has_.foveated && foveated.supportsFoveatedRendering;
  hands_here_ = has_.hands && hands.supportsHandTracking;
  gaze_here_ = has_.gaze && gaze.supportsEyeGazeInteraction;
  return {};
}

Status Runtime::ask_vulkan() {
  XrGraphicsRequirementsVulkan2KHR needs{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
  NERITIC_TRY_STATUS(check(xr_.GetVulkanGraphicsRequirements2KHR(instance_, system_, &needs),
                           "xrGetVulkanGraphicsRequirements2KHR"));
  if (needs.minApiVersionSupported > XR_MAKE_VERSION(1, 3, 0))
    return failure(ErrorCode::kUnsupported, "{} needs Vulkan {}.{}; this program uses 1.3",
                   info_.runtime, XR_VERSION_MAJOR(needs.minApiVersionSupported),
                   XR_VERSION_MINOR(needs.minApiVersionSupported));
  return {};
}

Runtime::~Runtime() {
  if (instance_ == XR_NULL_HANDLE) return;
  if (messenger_ != XR_NULL_HANDLE) (void)xr_.DestroyDebugUtilsMessengerEXT(messenger_);
  if (xr_.DestroyInstance) (void)xr_.DestroyInstance(instance_);
}

Status Runtime::check(XrResult result, const char* call) {
  if (XR_SUCCEEDED(result)) return {};
  switch (result) {
    case XR_ERROR_SESSION_LOST:
      lose(Loss::kSession);
      break;
    case XR_ERROR_INSTANCE_LOST:
    case XR_ERROR_RUNTIME_UNAVAILABLE:
      lose(Loss::kInstance);
      break;
    case XR_ERROR_RUNTIME_FAILURE:
      failed_ = true;
      break;
    default:
      break;
  }
  return failure(ErrorCode::kDeviceLost, "{}: {}: {}", info_.runtime, call, name_of(result));
}

bool Runtime::goes_without(const Error& error, std::string_view without) {
  if (loss_ != Loss::kNone) return false;
  failed_ = false;
  log_warn("{}: {}", error.message, without);
  return true;
}

TimeNs Runtime::to_host(XrTime time) const {
  timespec host{};
  if (xr_.ConvertTimeToTimespecTimeKHR && has_.timespec &&
      XR_SUCCEEDED(xr_.ConvertTimeToTimespecTimeKHR(instance_, time, &host)))
    return TimeNs{host.tv_sec} * 1'000'000'000 + host.tv_nsec;
  return time + host_minus_xr_ns_;
}

void Runtime::note_frame(XrTime display_at, XrDuration period) {
  // Frames are shown a period after their start at the earliest. A late return makes the
  // difference larger, never smaller, so that the smallest is the best.
  const TimeNs difference = now_ns() + period - display_at;
  host_minus_xr_ns_ = clocks_met_ ? std::min(host_minus_xr_ns_, difference) : difference;
  clocks_met_ = true;
}

// The extensions of Vulkan that XR_KHR_vulkan_enable wants of a device or an instance.
Result<std::vector<std::string>> Runtime::wanted_by_version1(bool device) {
  const auto ask = device ? xr_.GetVulkanDeviceExtensionsKHR : xr_.GetVulkanInstanceExtensionsKHR;
  if (!has_.vulkan1 || !ask) return std::vector<std::string>{};
  std::vector<char> text;
  const XrResult result = enumerate(text, '\0', [&](auto capacity, auto count, auto items) {
    return ask(instance_, system_, capacity, count, items);
  });
  NERITIC_TRY_STATUS(check(
      result, device ? "xrGetVulkanDeviceExtensionsKHR" : "xrGetVulkanInstanceExtensionsKHR"));
  text.push_back('\0');
  std::vector<std::string> names;
  std::istringstream words(text.data());
  for (std::string name; words >> name;) names.push_back(name);
  return names;
}

VkResult Runtime::make_instance(const VkInstanceCreateInfo& info, VkInstance* instance,
                                EnabledVulkan& enabled) {
  const auto make = [&](const VkInstanceCreateInfo& with) {
    XrVulkanInstanceCreateInfoKHR create{XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR};
    create.systemId = system_;
    create.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    create.vulkanCreateInfo = &with;
    VkResult vulkan = VK_SUCCESS;
    const XrResult result = xr_.CreateVulkanInstanceKHR(instance_, &create, instance, &vulkan);
    if (XR_SUCCEEDED(result)) return vulkan;
    log_info("{}: xrCreateVulkanInstanceKHR: {}", info_.runtime, name_of(result));
    return VK_ERROR_INITIALIZATION_FAILED;
  };
  const VkResult made = make_with_wished(info, wanted_by_version1(false), offered_by_vulkan(),
                                         enabled.instance, make);
  made_ = made == VK_SUCCESS ? *instance : VK_NULL_HANDLE;
  return made;
}

VkResult Runtime::find_physical(VkInstance instance, VkPhysicalDevice* device) {
  XrVulkanGraphicsDeviceGetInfoKHR get{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR};
  get.systemId = system_;
  get.vulkanInstance = instance;
  const XrResult result = xr_.GetVulkanGraphicsDevice2KHR(instance_, &get, device);
  if (XR_SUCCEEDED(result)) return VK_SUCCESS;
  log_info("{}: xrGetVulkanGraphicsDevice2KHR: {}", info_.runtime, name_of(result));
  return VK_ERROR_INITIALIZATION_FAILED;
}

VkResult Runtime::make_device(VkPhysicalDevice physical, const VkDeviceCreateInfo& info,
                              VkDevice* device, EnabledVulkan& enabled) {
  const auto make = [&](const VkDeviceCreateInfo& with) {
    XrVulkanDeviceCreateInfoKHR create{XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR};
    create.systemId = system_;
    create.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    create.vulkanPhysicalDevice = physical;
    create.vulkanCreateInfo = &with;
    VkResult vulkan = VK_SUCCESS;
    const XrResult result = xr_.CreateVulkanDeviceKHR(instance_, &create, device, &vulkan);
    if (XR_SUCCEEDED(result)) return vulkan;
    log_info("{}: xrCreateVulkanDeviceKHR: {}", info_.runtime, name_of(result));
    return VK_ERROR_INITIALIZATION_FAILED;
  };
  return make_with_wished(info, wanted_by_version1(true), offered_by_vulkan(physical),
                          enabled.device, make);
}

Status Runtime::check_device(const gpu::Device& device, const EnabledVulkan& enabled) {
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  if (made_ == device.instance()) {
    XrVulkanGraphicsDeviceGetInfoKHR get{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR};
    get.systemId = system_;
    get.vulkanInstance = made_;
    NERITIC_TRY_STATUS(check(xr_.GetVulkanGraphicsDevice2KHR(instance_, &get, &physical),
                             "xrGetVulkanGraphicsDevice2KHR"));
  } else {
    NERITIC_TRY_STATUS(check_version1(device, enabled));
    NERITIC_TRY_STATUS(
        check(xr_.GetVulkanGraphicsDeviceKHR(instance_, system_, device.instance(), &physical),
              "xrGetVulkanGraphicsDeviceKHR"));
  }
  if (physical != device.physical())
    return failure(ErrorCode::kUnsupported,
                   "{} came back on another graphics device than {}: start the dive again",
                   info_.runtime, device.info().name);
  return {};
}

// Whether the runtime takes a device that it did not make, and this one.
Status Runtime::check_version1(const gpu::Device& device, const EnabledVulkan& enabled) {
  if (!has_.vulkan1 || !xr_.GetVulkanGraphicsRequirementsKHR || !xr_.GetVulkanGraphicsDeviceKHR)
    return failure(ErrorCode::kUnsupported,
                   "{} came back without {}, so that it takes no graphics device but one that it "
                   "makes anew: start the dive again",
                   info_.runtime, XR_KHR_VULKAN_ENABLE_EXTENSION_NAME);
  XrGraphicsRequirementsVulkanKHR needs{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN_KHR};
  NERITIC_TRY_STATUS(check(xr_.GetVulkanGraphicsRequirementsKHR(instance_, system_, &needs),
                           "xrGetVulkanGraphicsRequirementsKHR"));
  for (const bool of_device : {false, true}) {
    NERITIC_TRY(const auto wanted, wanted_by_version1(of_device));
    for (const std::string& name : wanted)
      if (!contains(of_device ? enabled.device : enabled.instance, name.c_str()))
        return failure(ErrorCode::kUnsupported,
                       "{} came back and needs Vulkan's {}, without which this dive began on {}: "
                       "start the dive again",
                       info_.runtime, name, device.info().name);
  }
  return {};
}

}  // namespace neritic::xr::openxr
