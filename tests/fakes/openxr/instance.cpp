// Negotiation with the loader, the instance, its system, paths and events.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

struct OfferedExtension {
  const char* name;
  std::uint32_t version;
};
constexpr OfferedExtension kExtensions[] = {
    {XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME, XR_KHR_vulkan_enable2_SPEC_VERSION},
    {XR_KHR_VULKAN_ENABLE_EXTENSION_NAME, XR_KHR_vulkan_enable_SPEC_VERSION},
    {XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME, XR_KHR_composition_layer_depth_SPEC_VERSION},
    {XR_KHR_COMPOSITION_LAYER_CYLINDER_EXTENSION_NAME,
     XR_KHR_composition_layer_cylinder_SPEC_VERSION},
    {XR_KHR_VISIBILITY_MASK_EXTENSION_NAME, XR_KHR_visibility_mask_SPEC_VERSION},
    {XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME, XR_KHR_convert_timespec_time_SPEC_VERSION},
    {XR_EXT_HAND_TRACKING_EXTENSION_NAME, XR_EXT_hand_tracking_SPEC_VERSION},
    {XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME, XR_EXT_eye_gaze_interaction_SPEC_VERSION},
    {XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME, XR_FB_display_refresh_rate_SPEC_VERSION},
    {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME, XR_VARJO_quad_views_SPEC_VERSION},
    {XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME, XR_VARJO_foveated_rendering_SPEC_VERSION},
    {XR_EXTX_OVERLAY_EXTENSION_NAME, XR_EXTX_overlay_SPEC_VERSION},
};

template <std::size_t kSize>
void put(char (&to)[kSize], const std::string& text) {
  std::snprintf(to, kSize, "%s", text.c_str());
}

XrResult enumerate_extensions(Call& call, const char* layer, std::uint32_t capacity,
                              std::uint32_t* count, XrExtensionProperties* properties) {
  if (layer) call.refuse(XR_ERROR_API_LAYER_NOT_PRESENT);
  const auto offered = offered_extensions(call.rt.script);
  for (std::uint32_t i = 0; i < capacity && properties; ++i) call.out(properties + i);
  call.fill(capacity, count, properties, offered);
  return XR_SUCCESS;
}

void check_application(Call& call, const XrApplicationInfo& info) {
  call.require(info.applicationName[0] != 0, XR_ERROR_NAME_INVALID, "applicationName is empty");
  const bool one = XR_VERSION_MAJOR(info.apiVersion) == 1 && XR_VERSION_MINOR(info.apiVersion) == 0;
  call.require(one, XR_ERROR_API_VERSION_UNSUPPORTED, "apiVersion is not 1.0, which is supported");
}

XrResult create_instance(Call& call, const XrInstanceCreateInfo* create, XrInstance* handle) {
  const auto& info = call.in(create, {{XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT}});
  call.not_null(handle, "the instance");
  call.require(info.createFlags == 0, XR_ERROR_VALIDATION_FAILURE, "createFlags is not 0");
  check_application(call, info.applicationInfo);
  if (!call.rt.script.available) call.refuse(XR_ERROR_RUNTIME_UNAVAILABLE);
  if (call.rt.script.instance_refusals > 0) {
    --call.rt.script.instance_refusals;
    call.refuse(XR_ERROR_RUNTIME_UNAVAILABLE);
  }
  if (call.rt.instance()) call.refuse(XR_ERROR_LIMIT_REACHED);
  std::set<std::string> enabled;
  const auto offered = offered_extensions(call.rt.script);
  for (std::uint32_t i = 0; i < info.enabledExtensionCount; ++i) {
    const std::string name = info.enabledExtensionNames[i];
    const bool known = std::any_of(offered.begin(), offered.end(),
                                   [&](const auto& one) { return name == one.extensionName; });
    call.require(known, XR_ERROR_EXTENSION_NOT_PRESENT,
                 "the extension " + name + " was asked for, but not offered");
    enabled.insert(name);
  }
  call.require(!enabled.contains(XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME) ||
                   enabled.contains(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME),
               XR_ERROR_VALIDATION_FAILURE,
               "XR_VARJO_foveated_rendering needs XR_VARJO_quad_views");
  if (call.rt.script.real_time && call.rt.host_epoch_ns == 0) {
    call.rt.host_epoch_ns = real_now(call.rt) - kEpoch;
  }
  Instance& made = call.add<Instance>();
  made.extensions = std::move(enabled);
  *handle = handle_of(made);
  return XR_SUCCESS;
}

XrResult destroy_instance(Call& call, XrInstance handle) {
  call.rt.destroy(call.get_to_destroy<Instance>(handle));
  return XR_SUCCESS;
}

XrResult instance_properties(Call& call, XrInstance handle, XrInstanceProperties* properties) {
  call.get<Instance>(handle);
  XrInstanceProperties& to = call.out(properties);
  to.runtimeVersion = XR_MAKE_VERSION(0, 1, 0);
  put(to.runtimeName, "Neritic fake runtime");
  return XR_SUCCESS;
}

XrResult poll_event(Call& call, XrInstance handle, XrEventDataBuffer* event) {
  Instance& instance = call.get<Instance>(handle);
  call.out(event);
  if (instance.events.empty()) {
    for (auto& [id, object] : call.rt.objects) {
      if (object->type != XR_OBJECT_TYPE_SESSION) continue;
      auto& session = static_cast<Session&>(*object);
      if (session.wake_after_polls > 0 && session.state == XR_SESSION_STATE_IDLE &&
          --session.wake_after_polls == 0) {
        change_state(session, XR_SESSION_STATE_READY);
      }
    }
    return XR_EVENT_UNAVAILABLE;
  }
  *event = instance.events.front();
  instance.events.pop_front();
  return XR_SUCCESS;
}

XrResult result_to_string(Call& call, XrInstance handle, XrResult value, char* text) {
  call.get_to_destroy<Instance>(handle);
  std::snprintf(call.not_null(text, "the buffer"), XR_MAX_RESULT_STRING_SIZE, "%s",
                name_of(value).c_str());
  return XR_SUCCESS;
}

XrResult structure_to_string(Call& call, XrInstance handle, XrStructureType value, char* text) {
  call.get_to_destroy<Instance>(handle);
  std::snprintf(call.not_null(text, "the buffer"), XR_MAX_STRUCTURE_NAME_SIZE, "%s",
                name_of(value).c_str());
  return XR_SUCCESS;
}

// Lower-case letters, digits, '-', '_', '.' between slashes; at its start a slash.
bool path_is_well_formed(const std::string& path) {
  if (path.size() < 2 || path[0] != '/' || path.back() == '/' ||
      path.size() >= XR_MAX_PATH_LENGTH) {
    return false;
  }
  if (path.find("//") != std::string::npos) return false;
  return path.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_./") == std::string::npos;
}

XrResult string_to_path(Call& call, XrInstance handle, const char* text, XrPath* path) {
  Instance& instance = call.get<Instance>(handle);
  const std::string wanted = call.not_null(text, "the text");
  call.require(path_is_well_formed(wanted), XR_ERROR_PATH_FORMAT_INVALID,
               "'" + wanted + "' is not a well-formed path");
  auto& paths = instance.paths;
  const auto found = std::find(paths.begin(), paths.end(), wanted);
  *call.not_null(path, "the path") = static_cast<XrPath>(found - paths.begin()) + 1;
  if (found == paths.end()) paths.push_back(wanted);
  return XR_SUCCESS;
}

XrResult path_to_string(Call& call, XrInstance handle, XrPath path, std::uint32_t capacity,
                        std::uint32_t* count, char* text) {
  call.get<Instance>(handle);
  std::string found = call.path(path);
  found.push_back('\0');
  call.fill(capacity, count, text, found);
  return XR_SUCCESS;
}

XrResult get_system(Call& call, XrInstance handle, const XrSystemGetInfo* get, XrSystemId* system) {
  Instance& instance = call.get<Instance>(handle);
  const auto& info = call.in(get);
  if (info.formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY) {
    call.refuse(XR_ERROR_FORM_FACTOR_UNSUPPORTED);
  }
  if (call.rt.script.system_refusals > 0) {
    --call.rt.script.system_refusals;
    call.refuse(XR_ERROR_FORM_FACTOR_UNAVAILABLE);
  }
  instance.has_system = true;
  *call.not_null(system, "the system") = kSystem;
  return XR_SUCCESS;
}

XrResult system_properties(Call& call, XrInstance handle, XrSystemId system,
                           XrSystemProperties* properties) {
  Instance& instance = call.get<Instance>(handle);
  call.require(instance.has_system && system == kSystem, XR_ERROR_SYSTEM_INVALID,
               "the system was not got by xrGetSystem");
  XrSystemProperties& to =
      call.out(properties,
               {{XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT, XR_EXT_HAND_TRACKING_EXTENSION_NAME},
                {XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT,
                 XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME},
                {XR_TYPE_SYSTEM_FOVEATED_RENDERING_PROPERTIES_VARJO,
                 XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME}});
  const Script& script = call.rt.script;
  to.systemId = kSystem;
  to.vendorId = 0x4E45;
  put(to.systemName, script.name);
  to.graphicsProperties = {script.max_size, script.max_size, script.max_layers};
  to.trackingProperties = {XR_TRUE, XR_TRUE};
  if (auto* hands = Call::chained<XrSystemHandTrackingPropertiesEXT>(to.next)) {
    hands->supportsHandTracking = !script.hands[0].empty() || !script.hands[1].empty();
  }
  if (auto* gaze = Call::chained<XrSystemEyeGazeInteractionPropertiesEXT>(to.next)) {
    gaze->supportsEyeGazeInteraction = !script.gaze.empty();
  }
  if (auto* foveated = Call::chained<XrSystemFoveatedRenderingPropertiesVARJO>(to.next)) {
    foveated->supportsFoveatedRendering = !script.gaze.empty();
  }
  return XR_SUCCESS;
}

// CLOCK_MONOTONIC and XrTime; in simulated time the former is the script's time.
XrResult timespec_to_time(Call& call, XrInstance handle, const timespec* from, XrTime* to) {
  call.get<Instance>(handle);
  call.not_null(from, "the timespec");
  const std::int64_t host_ns = std::int64_t{from->tv_sec} * 1'000'000'000 + from->tv_nsec;
  *call.not_null(to, "the time") = host_ns - call.rt.host_epoch_ns + kEpoch;
  return XR_SUCCESS;
}

XrResult time_to_timespec(Call& call, XrInstance handle, XrTime from, timespec* to) {
  call.get<Instance>(handle);
  call.check_time(from);
  const std::int64_t host_ns = from - kEpoch + call.rt.host_epoch_ns;
  call.not_null(to, "the timespec");
  to->tv_sec = host_ns / 1'000'000'000;
  to->tv_nsec = host_ns % 1'000'000'000;
  return XR_SUCCESS;
}

XrResult get_proc_addr(Call& call, XrInstance handle, const char* name, PFN_xrVoidFunction* to) {
  *call.not_null(to, "the function") = nullptr;
  const std::string_view wanted = call.not_null(name, "the name");
  const bool global = wanted == "xrEnumerateInstanceExtensionProperties" ||
                      wanted == "xrEnumerateApiLayerProperties" || wanted == "xrCreateInstance";
  if (handle == XR_NULL_HANDLE) {
    call.require(global, XR_ERROR_HANDLE_INVALID,
                 fmt::format("'{}' was asked for without an instance", wanted));
  } else {
    call.get_to_destroy<Instance>(handle);
  }
  for (const Row& one : function_table()) {
    if (wanted != one.name) continue;
    if (handle != XR_NULL_HANDLE && !call.enabled(one.extension)) break;
    *to = one.function;
    return XR_SUCCESS;
  }
  return XR_ERROR_FUNCTION_UNSUPPORTED;
}

}  // namespace

std::vector<XrExtensionProperties> offered_extensions(const Script& script) {
  std::vector<XrExtensionProperties> offered;
  for (const OfferedExtension& one : kExtensions) {
    if (script.without.contains(one.name) || script.without.contains("extensions")) continue;
    XrExtensionProperties properties{XR_TYPE_EXTENSION_PROPERTIES};
    put(properties.extensionName, one.name);
    properties.extensionVersion = one.version;
    offered.push_back(properties);
  }
  return offered;
}

// The loader's side (chapter "Loader runtime interaction" of the loader's specification).
struct NegotiateLoaderInfo {
  std::uint32_t structType, structVersion;
  std::size_t structSize;
  std::uint32_t minInterfaceVersion, maxInterfaceVersion;
  XrVersion minApiVersion, maxApiVersion;
};
struct NegotiateRuntimeRequest {
  std::uint32_t structType, structVersion;
  std::size_t structSize;
  std::uint32_t runtimeInterfaceVersion;
  XrVersion runtimeApiVersion;
  PFN_xrGetInstanceProcAddr getInstanceProcAddr;
};

void add_instance_functions(Table& table) {
  table.insert(table.end(),
               {NERITIC_XR_ROW(xrGetInstanceProcAddr, get_proc_addr, ""),
                NERITIC_XR_ROW(xrEnumerateInstanceExtensionProperties, enumerate_extensions, ""),
                NERITIC_XR_ROW(xrCreateInstance, create_instance, ""),
                NERITIC_XR_ROW(xrDestroyInstance, destroy_instance, ""),
                NERITIC_XR_ROW(xrGetInstanceProperties, instance_properties, ""),
                NERITIC_XR_ROW(xrPollEvent, poll_event, ""),
                NERITIC_XR_ROW(xrResultToString, result_to_string, ""),
                NERITIC_XR_ROW(xrStructureTypeToString, structure_to_string, ""),
                NERITIC_XR_ROW(xrStringToPath, string_to_path, ""),
                NERITIC_XR_ROW(xrPathToString, path_to_string, ""),
                NERITIC_XR_ROW(xrGetSystem, get_system, ""),
                NERITIC_XR_ROW(xrGetSystemProperties, system_properties, ""),
                NERITIC_XR_ROW(xrConvertTimespecTimeToTimeKHR, timespec_to_time,
                               XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME),
                NERITIC_XR_ROW(xrConvertTimeToTimespecTimeKHR, time_to_timespec,
                               XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME)});
}

}  // namespace neritic::fakes

// The entry that the loader looks up.
extern "C" __attribute__((visibility("default"))) XrResult XRAPI_CALL
xrNegotiateLoaderRuntimeInterface(const neritic::fakes::NegotiateLoaderInfo* loader,
                                  neritic::fakes::NegotiateRuntimeRequest* request) {
  constexpr std::uint32_t kLoaderInfo = 1, kRuntimeRequest = 3, kInterface = 1;
  if (!loader || !request || loader->structType != kLoaderInfo ||
      request->structType != kRuntimeRequest || loader->minInterfaceVersion > kInterface ||
      loader->maxInterfaceVersion < kInterface) {
    return XR_ERROR_INITIALIZATION_FAILED;
  }
  request->runtimeInterfaceVersion = kInterface;
  request->runtimeApiVersion = XR_CURRENT_API_VERSION;
  for (const neritic::fakes::Row& row : neritic::fakes::function_table()) {
    if (std::string_view(row.name) == "xrGetInstanceProcAddr") {
      request->getInstanceProcAddr = reinterpret_cast<PFN_xrGetInstanceProcAddr>(row.function);
    }
  }
  return XR_SUCCESS;
}
