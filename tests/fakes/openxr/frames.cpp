// The frame loop on simulated time: wait, begin, end.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

Session& running(Call& call, XrSession handle) {
  Session& session = call.get<Session>(handle);
  call.require(session.running, XR_ERROR_SESSION_NOT_RUNNING, "the session is not running");
  return session;
}

// Steps the time to that of the next frame; in real time, waits for it.
void step_time(Call& call, const Session& session, std::uint64_t number) {
  Runtime& rt = call.rt;
  const auto late = rt.script.late.find(number);
  const int periods = 1 + (late == rt.script.late.end() ? 0 : late->second);
  const auto period = static_cast<XrTime>(std::llround(session.period_s * 1e9));
  if (!rt.script.real_time) {
    rt.now += periods * period;
    return;
  }
  const XrTime passed = std::max<XrTime>(0, real_now(rt) - rt.now);
  rt.now += std::max<XrTime>(periods, (passed + period - 1) / period) * period;
  call.sleep(static_cast<double>(rt.now - real_now(rt)) * 1e-9);
}

XrResult wait_frame(Call& call, XrSession handle, const XrFrameWaitInfo* wait,
                    XrFrameState* state) {
  Session& session = running(call, handle);
  if (wait) call.in(wait);
  XrFrameState& to = call.out(state);
  if (session.has_waited) {
    // Blocks until another thread begins the frame before.
    const std::uint64_t id = session.handle;
    const bool begun = call.wait_for(
        [&] { return !call.rt.objects.contains(id) || !session.has_waited || !session.running; });
    call.require(
        begun, XR_ERROR_CALL_ORDER_INVALID,
        "the frame of the last xrWaitFrame was not begun, and this call blocks until it is");
  }
  const std::uint64_t number = session.next_frame++;
  perform_timed(call, number);
  running(call, handle);
  step_time(call, session, number);
  const double lead = call.rt.script.lead_periods * session.period_s;
  session.waited = {number, call.rt.now + static_cast<XrTime>(std::llround(lead * 1e9))};
  session.has_waited = true;
  to.predictedDisplayTime = session.waited.display_time;
  to.predictedDisplayPeriod = static_cast<XrDuration>(std::llround(session.period_s * 1e9));
  to.shouldRender =
      session.state == XR_SESSION_STATE_VISIBLE || session.state == XR_SESSION_STATE_FOCUSED;
  return XR_SUCCESS;
}

XrResult begin_frame(Call& call, XrSession handle, const XrFrameBeginInfo* begin) {
  Session& session = running(call, handle);
  if (begin) call.in(begin);
  call.require(session.has_waited, XR_ERROR_CALL_ORDER_INVALID,
               "no xrWaitFrame came before it for this frame");
  const bool discarded = session.has_begun;
  session.begun = session.waited;
  session.has_begun = true;
  session.has_waited = false;
  call.rt.changed.notify_all();
  return discarded ? XR_FRAME_DISCARDED : XR_SUCCESS;
}

// How far the views of a projection layer are from the eyes at the time they are shown.
std::string view_errors(Runtime& rt, const Session& session,
                        const XrCompositionLayerProjection& layer, XrTime time) {
  const auto& space =
      static_cast<const Space&>(*rt.objects.at(reinterpret_cast<std::uint64_t>(layer.space)));
  const Pose world_from_space = locate(rt, space, time).pose;
  const Pose head = locate_view_space(rt, time).pose;
  const auto views = views_in_head(rt.script, session.views, {});
  double metres = 0, radians = 0;
  for (std::uint32_t i = 0; i < layer.viewCount; ++i) {
    const Pose shown = world_from_space * from_xr(layer.views[i].pose);
    const Pose eye = head * from_xr(views[i].pose);
    metres = std::max(metres, glm::distance(shown.position, eye.position));
    const double w = std::abs(glm::dot(shown.rotation, eye.rotation));
    radians = std::max(radians, 2 * std::acos(std::min(w, 1.0)));
  }
  const XrExtent2Di& size = layer.views[0].subImage.imageRect.extent;
  return fmt::format("{:.2f} mm {:.2f} deg of {} x {}", metres * 1000, glm::degrees(radians),
                     size.width, size.height);
}

// "frame 7 display 10155555555 projection 0.00 mm 0.00 deg of 640 x 600 quad cylinder"
void log_frame(Runtime& rt, const Session& session, const XrFrameEndInfo& info) {
  std::string line = fmt::format("frame {} display {}", session.begun.number, info.displayTime);
  for (std::uint32_t i = 0; i < info.layerCount; ++i) {
    const XrCompositionLayerBaseHeader* layer = info.layers[i];
    if (layer->type == XR_TYPE_COMPOSITION_LAYER_QUAD) line += " quad";
    if (layer->type == XR_TYPE_COMPOSITION_LAYER_CYLINDER_KHR) line += " cylinder";
    if (layer->type != XR_TYPE_COMPOSITION_LAYER_PROJECTION) continue;
    line += " projection " +
            view_errors(rt, session, reinterpret_cast<const XrCompositionLayerProjection&>(*layer),
                        info.displayTime);
  }
  rt.log.push_back(line);
}

XrResult end_frame(Call& call, XrSession handle, const XrFrameEndInfo* end) {
  Session& session = running(call, handle);
  const auto& info = call.in(end);
  call.require(session.has_begun, XR_ERROR_CALL_ORDER_INVALID,
               "no xrBeginFrame came before it for this frame");
  call.require(info.displayTime == session.begun.display_time, XR_ERROR_TIME_INVALID,
               fmt::format("displayTime is {}; it must be the frame's predictedDisplayTime {}",
                           info.displayTime, session.begun.display_time));
  if (info.environmentBlendMode != XR_ENVIRONMENT_BLEND_MODE_OPAQUE) {
    call.fault(XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED,
               "environmentBlendMode is not among xrEnumerateEnvironmentBlendModes");
  }
  check_layers(call, session, info);
  compose(call, session, info);
  log_frame(call.rt, session, info);
  session.has_begun = false;
  if (session.state == XR_SESSION_STATE_READY) change_state(session, XR_SESSION_STATE_FOCUSED);
  return XR_SUCCESS;
}

}  // namespace

XrTime real_now(const Runtime& runtime) {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec - runtime.host_epoch_ns + kEpoch;
}

void add_frame_functions(Table& table) {
  table.insert(table.end(), {NERITIC_XR_ROW(xrWaitFrame, wait_frame, ""),
                             NERITIC_XR_ROW(xrBeginFrame, begin_frame, ""),
                             NERITIC_XR_ROW(xrEndFrame, end_frame, "")});
}

}  // namespace neritic::fakes
