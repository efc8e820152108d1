#include "engine/xr/openxr/session.hpp"

#include <algorithm>

#include "engine/core/log.hpp"

namespace neritic::xr::openxr {

Result<std::unique_ptr<Session>> Session::create(Runtime& runtime, const gpu::Device& device,
                                                 const HeadsetOptions& options) {
  std::unique_ptr<Session> session(new Session(runtime));
  XrGraphicsBindingVulkan2KHR binding{XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR};
  binding.instance = device.instance();
  binding.physicalDevice = device.physical();
  binding.device = device.handle();
  binding.queueFamilyIndex = device.queue_family();
  XrSessionCreateInfoOverlayEXTX overlay{XR_TYPE_SESSION_CREATE_INFO_OVERLAY_EXTX};
  if (options.overlay) binding.next = &overlay;
  XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &binding};
  info.systemId = runtime.system();
  NERITIC_TRY_STATUS(runtime.check(
      runtime.xr().CreateSession(runtime.instance(), &info, &session->handle_), "xrCreateSession"));
  NERITIC_TRY_STATUS(session->create_spaces(options.room));
  if (options.refresh_hz > 0.0)
    if (const Status set = session->set_refresh_rate(options.refresh_hz);
        !set.ok() && !runtime.goes_without(set.error(), "the display keeps its own rate"))
      return set.error();
  return session;
}

Session::~Session() {
  // Its spaces go with it.
  if (handle_ != XR_NULL_HANDLE) (void)runtime_.xr().DestroySession(handle_);
}

Result<XrSpace> Session::reference_space(XrReferenceSpaceType type) {
  XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO};
  info.referenceSpaceType = type;
  info.poseInReferenceSpace = to_xr({});
  XrSpace space = XR_NULL_HANDLE;
  NERITIC_TRY_STATUS(runtime_.check(runtime_.xr().CreateReferenceSpace(handle_, &info, &space),
                                    "xrCreateReferenceSpace"));
  return space;
}

Status Session::create_spaces(bool room) {
  std::vector<XrReferenceSpaceType> types;
  const XrResult result =
      enumerate(types, XR_REFERENCE_SPACE_TYPE_LOCAL, [&](auto capacity, auto count, auto items) {
        return runtime_.xr().EnumerateReferenceSpaces(handle_, capacity, count, items);
      });
  NERITIC_TRY_STATUS(runtime_.check(result, "xrEnumerateReferenceSpaces"));
  const bool stage =
      std::find(types.begin(), types.end(), XR_REFERENCE_SPACE_TYPE_STAGE) != types.end();
  in_room_ = room && stage;
  if (room && !stage)
    log_warn("{} knows no room: the lab's origin is where the wearer recentred",
             runtime_.info().runtime);
  NERITIC_TRY(stage_, reference_space(in_room_ ? XR_REFERENCE_SPACE_TYPE_STAGE
                                               : XR_REFERENCE_SPACE_TYPE_LOCAL));
  NERITIC_TRY(head_, reference_space(XR_REFERENCE_SPACE_TYPE_VIEW));
  return {};
}

Status Session::set_refresh_rate(double wanted_hz) {
  if (!runtime_.has().refresh_rate || !runtime_.xr().RequestDisplayRefreshRateFB) {
    log_warn("{} does not let programs choose the display's rate", runtime_.info().runtime);
    return {};
  }
  std::vector<float> rates_hz;
  const XrResult result = enumerate(rates_hz, 0.0f, [&](auto capacity, auto count, auto items) {
    return runtime_.xr().EnumerateDisplayRefreshRatesFB(handle_, capacity, count, items);
  });
  NERITIC_TRY_STATUS(runtime_.check(result, "xrEnumerateDisplayRefreshRatesFB"));
  std::string offered;
  for (const float rate_hz : rates_hz) {
    offered += fmt::format("{}{:g}", offered.empty() ? "" : ", ", rate_hz);
    if (std::abs(rate_hz - wanted_hz) < 0.5)
      return runtime_.check(runtime_.xr().RequestDisplayRefreshRateFB(handle_, rate_hz),
                            "xrRequestDisplayRefreshRateFB");
  }
  log_warn("{} has no rate of {:g} Hz; it offers {}", runtime_.info().runtime, wanted_hz,
           offered.empty() ? "none" : offered);
  return {};
}

Status Session::poll(XrViewConfigurationType configuration) {
  for (;;) {
    XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
    const XrResult result = runtime_.xr().PollEvent(runtime_.instance(), &event);
    NERITIC_TRY_STATUS(runtime_.check(result, "xrPollEvent"));
    if (result == XR_EVENT_UNAVAILABLE) return {};
    const auto* header = reinterpret_cast<const XrEventDataBaseHeader*>(&event);
    switch (header->type) {
      case XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED: {
        const auto& changed = *reinterpret_cast<const XrEventDataSessionStateChanged*>(header);
        if (changed.session == handle_) NERITIC_TRY_STATUS(on_state(changed.state, configuration));
        break;
      }
      case XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING:
        runtime_.lose(Loss::kInstance);
        break;
      case XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING:
        on_recentred(*reinterpret_cast<const XrEventDataReferenceSpaceChangePending*>(header));
        break;
      case XR_TYPE_EVENT_DATA_DISPLAY_REFRESH_RATE_CHANGED_FB:
        log_info("the headset shows {:g} pictures a second",
                 reinterpret_cast<const XrEventDataDisplayRefreshRateChangedFB*>(header)
                     ->toDisplayRefreshRate);
        break;
      case XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR:
        mask_changed_ = true;
        break;
      default:
        break;
    }
  }
}

Status Session::on_state(XrSessionState state, XrViewConfigurationType configuration) {
  switch (state) {
    case XR_SESSION_STATE_READY: {
      XrSessionBeginInfo begin{XR_TYPE_SESSION_BEGIN_INFO};
      begin.primaryViewConfigurationType = configuration;
      NERITIC_TRY_STATUS(
          runtime_.check(runtime_.xr().BeginSession(handle_, &begin), "xrBeginSession"));
      running_ = true;
      return {};
    }
    case XR_SESSION_STATE_STOPPING:
      running_ = false;
      return runtime_.check(runtime_.xr().EndSession(handle_), "xrEndSession");
    case XR_SESSION_STATE_EXITING:
      running_ = false;
      exits_ = true;
      return {};
    case XR_SESSION_STATE_LOSS_PENDING:
      running_ = false;
      runtime_.lose(Loss::kSession);
      return {};
    default:
      return {};
  }
}

// A space that follows the wearer moves with it, and that is wanted. The room's must not move.
void Session::on_recentred(const XrEventDataReferenceSpaceChangePending& event) const {
  if (in_room_ && event.referenceSpaceType == XR_REFERENCE_SPACE_TYPE_STAGE)
    log_warn("{} moved the room's origin: find [lab] anew (neritic register)",
             runtime_.info().runtime);
}

}  // namespace neritic::xr::openxr
