// The session and its states.
#include <fmt/format.h>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

// Another of the same sort (main or overlay) may not be there.
void check_alone(Call& call, bool overlay) {
  for (const auto& [handle, object] : call.rt.objects) {
    if (object->type != XR_OBJECT_TYPE_SESSION) continue;
    if (static_cast<const Session&>(*object).overlay == overlay)
      call.refuse(XR_ERROR_LIMIT_REACHED);
  }
}

// XR_KHR_vulkan_enable: the device of xrGetVulkanGraphicsDeviceKHR, with the extensions that the
// runtime wants.
void check_client_device(Call& call, const VulkanObjects& vulkan) {
  for (const std::string& name : call.rt.script.vulkan_device)
    call.require(vulkan.device_extensions.contains(name), XR_ERROR_GRAPHICS_DEVICE_INVALID,
                 "the binding's device lacks " + name + " of xrGetVulkanDeviceExtensionsKHR");
}

void check_binding(Call& call, const VulkanObjects& vulkan,
                   const XrGraphicsBindingVulkanKHR* binding) {
  const auto invalid = XR_ERROR_GRAPHICS_DEVICE_INVALID;
  call.require(binding, invalid, "no XrGraphicsBindingVulkan2KHR stands in the next chain");
  if (vulkan.by_client) check_client_device(call, vulkan);
  call.require(binding->instance && binding->instance == vulkan.instance, invalid,
               "the binding's instance is not the one that xrCreateVulkanInstanceKHR made");
  call.require(binding->physicalDevice == vulkan.physical, invalid,
               "the binding's physicalDevice is not the one xrGetVulkanGraphicsDevice2KHR gave");
  call.require(binding->device && binding->device == vulkan.device, invalid,
               "the binding's device is not the one that xrCreateVulkanDeviceKHR made");
  const auto& families = vulkan.queue_families;
  call.require(
      std::find(families.begin(), families.end(), binding->queueFamilyIndex) != families.end(),
      invalid, "the device has no queue of the binding's queueFamilyIndex");
}

XrResult create_session(Call& call, XrInstance handle, const XrSessionCreateInfo* create,
                        XrSession* made) {
  Instance& instance = call.get<Instance>(handle);
  const auto& info =
      call.in(create, {{XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME},
                       {XR_TYPE_SESSION_CREATE_INFO_OVERLAY_EXTX, XR_EXTX_OVERLAY_EXTENSION_NAME}});
  call.not_null(made, "the session");
  call.require(info.createFlags == 0, XR_ERROR_VALIDATION_FAILURE, "createFlags is not 0");
  call.require(instance.has_system && info.systemId == kSystem, XR_ERROR_SYSTEM_INVALID,
               "the system was not got by xrGetSystem");
  const bool by_client = instance.vulkan.by_client;
  call.require(by_client ? instance.asked_requirements : instance.asked_requirements2,
               XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING,
               fmt::format("xrGetVulkanGraphicsRequirements{}KHR was not called before",
                           by_client ? "" : "2"));
  const auto* binding = Call::chained<XrGraphicsBindingVulkanKHR>(info.next);
  check_binding(call, instance.vulkan, binding);
  const auto* overlay = Call::chained<XrSessionCreateInfoOverlayEXTX>(info.next);
  check_alone(call, overlay != nullptr);

  Session& session = call.add<Session>(&instance);
  session.gpu =
      std::make_unique<Gpu>(instance.vulkan, binding->queueFamilyIndex, binding->queueIndex);
  session.overlay = overlay != nullptr;
  if (overlay) session.placement = overlay->sessionLayersPlacement;
  session.period_s = call.rt.script.period_s;
  *made = handle_of(session);
  if (session.overlay) {
    XrEventDataMainSessionVisibilityChangedEXTX event{};
    event.visible = call.rt.script.main_visible;
    queue(instance, event);
  }
  change_state(session, XR_SESSION_STATE_IDLE);
  change_state(session, XR_SESSION_STATE_READY);
  return XR_SUCCESS;
}

XrResult destroy_session(Call& call, XrSession handle) {
  call.rt.destroy(call.get_to_destroy<Session>(handle));
  return XR_SUCCESS;
}

XrResult begin_session(Call& call, XrSession handle, const XrSessionBeginInfo* begin) {
  Session& session = call.get<Session>(handle);
  const auto& info = call.in(begin);
  call.require(!session.running, XR_ERROR_SESSION_RUNNING, "the session is running");
  call.require(session.state == XR_SESSION_STATE_READY, XR_ERROR_SESSION_NOT_READY,
               "the session is in " + name_of(session.state) +
                   "; it may begin after the event of XR_SESSION_STATE_READY");
  const int views = call.rt.script.views;
  const auto type = info.primaryViewConfigurationType;
  const bool quad = views == 4 && type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO &&
                    call.enabled(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME);
  const bool stereo = views != 1 && type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  const bool mono = views == 1 && type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO;
  call.require(quad || stereo || mono, XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED,
               name_of(type) + " is not among xrEnumerateViewConfigurations");
  session.views = type;
  session.running = true;
  session.has_waited = session.has_begun = false;
  return XR_SUCCESS;
}

XrResult end_session(Call& call, XrSession handle) {
  Session& session = call.get<Session>(handle);
  call.require(session.running, XR_ERROR_SESSION_NOT_RUNNING, "the session is not running");
  call.require(session.state == XR_SESSION_STATE_STOPPING, XR_ERROR_SESSION_NOT_STOPPING,
               "the session is in " + name_of(session.state) +
                   "; it may end after the event of XR_SESSION_STATE_STOPPING");
  session.running = false;
  call.rt.changed.notify_all();
  change_state(session, XR_SESSION_STATE_IDLE);
  if (session.exit_requested) change_state(session, XR_SESSION_STATE_EXITING);
  return XR_SUCCESS;
}

XrResult request_exit(Call& call, XrSession handle) {
  Session& session = call.get<Session>(handle);
  call.require(session.running, XR_ERROR_SESSION_NOT_RUNNING, "the session is not running");
  session.exit_requested = true;
  change_state(session, XR_SESSION_STATE_STOPPING);
  return XR_SUCCESS;
}

XrResult enumerate_rates(Call& call, XrSession handle, std::uint32_t capacity, std::uint32_t* count,
                         float* rates) {
  call.get<Session>(handle);
  call.fill(capacity, count, rates, call.rt.script.refresh_rates);
  return XR_SUCCESS;
}

XrResult get_rate(Call& call, XrSession handle, float* rate) {
  const Session& session = call.get<Session>(handle);
  *call.not_null(rate, "the rate") = static_cast<float>(1 / session.period_s);
  return XR_SUCCESS;
}

XrResult request_rate(Call& call, XrSession handle, float rate) {
  Session& session = call.get<Session>(handle);
  const auto& rates = call.rt.script.refresh_rates;
  const double before = 1 / session.period_s;
  double wanted = 1 / call.rt.script.period_s;  // 0: no preference
  if (rate != 0) {
    call.require(std::find(rates.begin(), rates.end(), rate) != rates.end(),
                 XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB,
                 fmt::format("{} Hz is not among xrEnumerateDisplayRefreshRatesFB", rate));
    wanted = rate;
  }
  session.period_s = 1 / wanted;
  XrEventDataDisplayRefreshRateChangedFB event{};
  event.fromDisplayRefreshRate = static_cast<float>(before);
  event.toDisplayRefreshRate = static_cast<float>(wanted);
  if (before != wanted) queue(session.instance, event);
  return XR_SUCCESS;
}

}  // namespace

void add_session_functions(Table& table) {
  const char* rate = XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME;
  table.insert(table.end(),
               {NERITIC_XR_ROW(xrCreateSession, create_session, ""),
                NERITIC_XR_ROW(xrDestroySession, destroy_session, ""),
                NERITIC_XR_ROW(xrBeginSession, begin_session, ""),
                NERITIC_XR_ROW(xrEndSession, end_session, ""),
                NERITIC_XR_ROW(xrRequestExitSession, request_exit, ""),
                NERITIC_XR_ROW(xrEnumerateDisplayRefreshRatesFB, enumerate_rates, rate),
                NERITIC_XR_ROW(xrGetDisplayRefreshRateFB, get_rate, rate),
                NERITIC_XR_ROW(xrRequestDisplayRefreshRateFB, request_rate, rate)});
}

}  // namespace neritic::fakes
