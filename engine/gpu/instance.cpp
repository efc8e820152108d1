#include "engine/gpu/instance.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/core/log.hpp"
#include "engine/gpu/device_select.hpp"
#include "engine/gpu/error.hpp"

namespace neritic::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

// An image that nobody asked for has no attachment, and what a shader writes there is discarded
// (VkPipelineRenderingCreateInfo: VK_FORMAT_UNDEFINED). The layer warns of that all the same.
bool is_of_no_attachment(const char* id, const std::string& message) {
  return id && std::strcmp(id, "UNASSIGNED-CoreValidation-Shader-InterfaceTypeMismatch") == 0 &&
         message.find("VK_FORMAT_UNDEFINED") != message.npos;
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data,
                                          void* user) {
  const auto* target = static_cast<const ValidationTarget*>(user);
  const std::string message = data->pMessage ? data->pMessage : "(no message)";
  if (is_of_no_attachment(data->pMessageIdName, message)) return VK_FALSE;
  if (target->log) target->log->messages.push_back(message);
  if (target->sink) target->sink->messages.push_back(message);
  if (!target->log && !target->sink) log_warn("validation: {}", message);
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(ValidationTarget* target) {
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                         VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = on_message;
  info.pUserData = target;
  return info;
}

std::vector<VkExtensionProperties> extensions_of(const char* layer) {
  std::uint32_t count = 0;
  std::vector<VkExtensionProperties> out;
  if (vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) != VK_SUCCESS) return out;
  out.resize(count);
  if (vkEnumerateInstanceExtensionProperties(layer, &count, out.data()) < VK_SUCCESS) count = 0;
  out.resize(count);
  return out;
}

bool has(const std::vector<VkExtensionProperties>& extensions, const char* name) {
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

Status load_loader() {
  if (vkGetInstanceProcAddr) return {};
  if (volkInitialize() == VK_SUCCESS) return {};
  return failure(ErrorCode::kNoDevice,
                 "no Vulkan loader (libvulkan.so.1): install the Debian packages libvulkan1 and "
                 "mesa-vulkan-drivers");
}

}  // namespace

bool validation_layer_present() {
  if (!load_loader().ok()) return false;
  std::uint32_t count = 0;
  if (vkEnumerateInstanceLayerProperties(&count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkLayerProperties> layers(count);
  if (vkEnumerateInstanceLayerProperties(&count, layers.data()) < VK_SUCCESS) return false;
  layers.resize(count);
  return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& l) {
    return std::strcmp(l.layerName, kValidationLayer) == 0;
  });
}

Result<InstanceHandles> create_instance(const DeviceOptions& options, ValidationTarget* target) {
  NERITIC_TRY_STATUS(load_loader());
  if (volkGetInstanceVersion() < VK_API_VERSION_1_3)
    return failure(ErrorCode::kNoDevice,
                   "the Vulkan loader is older than 1.3: install the Debian package libvulkan1 of "
                   "Debian 12 or newer");
  if (options.validation && !validation_layer_present())
    return failure(ErrorCode::kUnsupported,
                   "validation needs {}: install the Debian package vulkan-validationlayers",
                   kValidationLayer);

  const auto present = extensions_of(nullptr);
  InstanceHandles handles;
  handles.debug_utils = has(present, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) || options.validation;
  std::vector<const char*> extensions;
  if (handles.debug_utils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  for (const char* name : options.instance_extensions) {
    if (!has(present, name))
      return failure(ErrorCode::kUnsupported, "the Vulkan loader has no instance extension {}",
                     name);
    extensions.push_back(name);
  }

  // Drivers that do not conform fully (MoltenVK) are listed only with this extension.
  const bool portability = has(present, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
  if (portability) extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);

  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "neritic";
  application.pEngineName = "neritic";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  if (portability) info.flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;

  // Synchronization validation is off by default in the layer; the messenger in pNext hears of the
  // instance's own creation and destruction.
  const std::array enabled{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  features.enabledValidationFeatureCount = enabled.size();
  features.pEnabledValidationFeatures = enabled.data();
  VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(target);
  if (options.validation) {
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
    features.pNext = &messenger;
    info.pNext = &messenger;
    if (has(extensions_of(kValidationLayer), VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME)) {
      extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
      info.pNext = &features;
    }
  }
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();

  const VkResult result = options.maker.instance
                              ? options.maker.instance(info, &handles.instance)
                              : vkCreateInstance(&info, nullptr, &handles.instance);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return no_device();
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreateInstance");
  // Trampolines fit any instance; only surface functions need the extensions that present brings.
  if (volkGetLoadedInstance() == VK_NULL_HANDLE || !options.instance_extensions.empty())
    volkLoadInstance(handles.instance);

  if (options.validation) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(handles.instance, "vkCreateDebugUtilsMessengerEXT"));
    const VkResult made = create ? create(handles.instance, &messenger, nullptr, &handles.messenger)
                                 : VK_ERROR_EXTENSION_NOT_PRESENT;
    if (made != VK_SUCCESS) {
      destroy_instance(handles);
      return vulkan_error(made, "vkCreateDebugUtilsMessengerEXT");
    }
  }
  return handles;
}

void destroy_instance(const InstanceHandles& handles) {
  if (handles.instance == VK_NULL_HANDLE) return;
  if (handles.messenger != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(handles.instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(handles.instance, handles.messenger, nullptr);
  }
  vkDestroyInstance(handles.instance, nullptr);
}

}  // namespace neritic::gpu
