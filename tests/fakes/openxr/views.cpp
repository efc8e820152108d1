// View configurations, the views' poses and frusta, visibility masks.
#include <fmt/format.h>

#include <cmath>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

constexpr auto kMono = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO;
constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
constexpr auto kQuad = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO;

// Best first.
std::vector<XrViewConfigurationType> configurations(Call& call) {
  const int views = call.rt.script.views;
  if (views == 1) return {kMono};
  if (views == 4 && call.enabled(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME)) return {kQuad, kStereo};
  return {kStereo};
}

void check_system(Call& call, XrInstance handle, XrSystemId system) {
  Instance& instance = call.get<Instance>(handle);
  call.require(instance.has_system && system == kSystem, XR_ERROR_SYSTEM_INVALID,
               "the system was not got by xrGetSystem");
}

void check_configuration(Call& call, XrViewConfigurationType type) {
  const auto offered = configurations(call);
  const bool known = std::find(offered.begin(), offered.end(), type) != offered.end();
  call.require(known, XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED,
               name_of(type) + " is not among xrEnumerateViewConfigurations");
}

XrResult enumerate_configurations(Call& call, XrInstance handle, XrSystemId system,
                                  std::uint32_t capacity, std::uint32_t* count,
                                  XrViewConfigurationType* types) {
  check_system(call, handle, system);
  call.fill(capacity, count, types, configurations(call));
  return XR_SUCCESS;
}

XrResult configuration_properties(Call& call, XrInstance handle, XrSystemId system,
                                  XrViewConfigurationType type,
                                  XrViewConfigurationProperties* properties) {
  check_system(call, handle, system);
  check_configuration(call, type);
  XrViewConfigurationProperties& to = call.out(properties);
  to.viewConfigurationType = type;
  to.fovMutable = XR_TRUE;
  return XR_SUCCESS;
}

XrResult enumerate_views(Call& call, XrInstance handle, XrSystemId system,
                         XrViewConfigurationType type, std::uint32_t capacity, std::uint32_t* count,
                         XrViewConfigurationView* views) {
  check_system(call, handle, system);
  check_configuration(call, type);
  const Script& script = call.rt.script;
  const std::uint32_t views_there = view_count(type);
  *call.not_null(count, "the count") = views_there;
  if (capacity == 0) return XR_SUCCESS;
  call.not_null(views, "the array");
  if (capacity < views_there) return XR_ERROR_SIZE_INSUFFICIENT;
  for (std::uint32_t i = 0; i < views_there; ++i) {
    XrViewConfigurationView& to =
        call.out(views + i, {{XR_TYPE_FOVEATED_VIEW_CONFIGURATION_VIEW_VARJO,
                              XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME}});
    const bool focus = i >= 2;
    to.recommendedImageRectWidth = focus ? script.focus_width : script.width;
    to.recommendedImageRectHeight = focus ? script.focus_height : script.height;
    const auto* foveated = Call::chained<XrFoveatedViewConfigurationViewVARJO>(to.next);
    if (foveated && foveated->foveatedRenderingActive && !focus) {
      // With the focus on the gaze the context views may be coarser.
      to.recommendedImageRectWidth = std::max(1u, script.width / 2);
      to.recommendedImageRectHeight = std::max(1u, script.height / 2);
    }
    to.maxImageRectWidth = to.maxImageRectHeight = script.max_size;
    to.recommendedSwapchainSampleCount = to.maxSwapchainSampleCount = 1;
  }
  return XR_SUCCESS;
}

XrResult enumerate_blend_modes(Call& call, XrInstance handle, XrSystemId system,
                               XrViewConfigurationType type, std::uint32_t capacity,
                               std::uint32_t* count, XrEnvironmentBlendMode* modes) {
  check_system(call, handle, system);
  check_configuration(call, type);
  const std::vector<XrEnvironmentBlendMode> offered{XR_ENVIRONMENT_BLEND_MODE_OPAQUE};
  call.fill(capacity, count, modes, offered);
  return XR_SUCCESS;
}

XrResult locate_views(Call& call, XrSession handle, const XrViewLocateInfo* locate_info,
                      XrViewState* state, std::uint32_t capacity, std::uint32_t* count,
                      XrView* views) {
  Session& session = call.get<Session>(handle);
  const auto& info = call.in(locate_info, {{XR_TYPE_VIEW_LOCATE_FOVEATED_RENDERING_VARJO,
                                            XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME}});
  call.out(state);
  call.check_time(info.displayTime);
  check_configuration(call, info.viewConfigurationType);
  const Space& base = call.get<Space>(info.space);
  call.require(&base.session == &session, XR_ERROR_VALIDATION_FAILURE,
               "the space belongs to another session");
  const std::uint32_t there = view_count(info.viewConfigurationType);
  *call.not_null(count, "the count") = there;
  if (capacity == 0) return XR_SUCCESS;
  call.not_null(views, "the array");
  if (capacity < there) return XR_ERROR_SIZE_INSUFFICIENT;

  const auto* foveated = Call::chained<XrViewLocateFoveatedRenderingVARJO>(info.next);
  std::optional<glm::dquat> gaze;
  const Script& script = call.rt.script;
  const double time_s = call.rt.seconds(info.displayTime);
  if (foveated && foveated->foveatedRenderingActive && !script.gaze.empty()) {
    gaze = script.gaze.at(time_s).rotation;
  }
  session.foveated = gaze.has_value();
  Located head = locate_view_space(call.rt, info.displayTime);
  // The eyes are always known from the head itself.
  if (base.reference == XR_REFERENCE_SPACE_TYPE_VIEW) head.oriented = head.positioned = true;
  const Pose base_from_head = inverse(locate(call.rt, base, info.displayTime).pose) * head.pose;
  const auto found = views_in_head(script, info.viewConfigurationType, gaze);
  for (std::uint32_t i = 0; i < there; ++i) {
    XrView& to = call.out(views + i);
    to.pose = to_xr(base_from_head * from_xr(found[i].pose));
    to.fov = found[i].fov;
    if (!head.oriented) to.pose.orientation = {NAN, NAN, NAN, NAN};
    if (!head.positioned) to.pose.position = kUnknown;
  }
  state->viewStateFlags = 0;
  if (head.oriented) state->viewStateFlags |= XR_VIEW_STATE_ORIENTATION_VALID_BIT;
  if (head.positioned) state->viewStateFlags |= XR_VIEW_STATE_POSITION_VALID_BIT;
  if (head.tracked) {
    state->viewStateFlags |=
        XR_VIEW_STATE_ORIENTATION_TRACKED_BIT | XR_VIEW_STATE_POSITION_TRACKED_BIT;
  }
  return XR_SUCCESS;
}

// The visible area is an octagon: the frustum's rectangle at depth 1 with its corners cut off by a
// quarter of each side.
XrResult visibility_mask(Call& call, XrSession handle, XrViewConfigurationType type,
                         std::uint32_t view, XrVisibilityMaskTypeKHR kind,
                         XrVisibilityMaskKHR* mask) {
  call.get<Session>(handle);
  check_configuration(call, type);
  call.require(view < view_count(type), XR_ERROR_VALIDATION_FAILURE,
               fmt::format("the view {} is not among the {}", view, view_count(type)));
  XrVisibilityMaskKHR& to = call.out(mask);
  const XrFovf fov = views_in_head(call.rt.script, type, {})[view].fov;
  const float l = std::tan(fov.angleLeft), r = std::tan(fov.angleRight);
  const float d = std::tan(fov.angleDown), u = std::tan(fov.angleUp);
  const float w = (r - l) / 4, h = (u - d) / 4;
  std::vector<XrVector2f> points{{l + w, d}, {r - w, d}, {r, d + h}, {r, u - h},
                                 {r - w, u}, {l + w, u}, {l, u - h}, {l, d + h}};
  std::vector<std::uint32_t> indices{0, 1, 2, 3, 4, 5, 6, 7};
  if (kind == XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR) {
    points.insert(points.end(), {{l, d}, {r, d}, {r, u}, {l, u}});
    indices = {8, 0, 7, 1, 9, 2, 3, 10, 4, 5, 11, 6};
  } else if (kind == XR_VISIBILITY_MASK_TYPE_VISIBLE_TRIANGLE_MESH_KHR) {
    indices.clear();
    for (std::uint32_t i = 1; i + 1 < 8; ++i) indices.insert(indices.end(), {0, i, i + 1});
  } else {
    call.require(kind == XR_VISIBILITY_MASK_TYPE_LINE_LOOP_KHR, XR_ERROR_VALIDATION_FAILURE,
                 "the kind of mask is none of the three");
  }
  if (view >= 2) points.clear(), indices.clear();  // a focus view is seen whole
  call.fill(to.vertexCapacityInput, &to.vertexCountOutput, to.vertices, points);
  call.fill(to.indexCapacityInput, &to.indexCountOutput, to.indices, indices);
  return XR_SUCCESS;
}

}  // namespace

std::uint32_t view_count(XrViewConfigurationType type) {
  return type == kMono ? 1 : type == kQuad ? 4 : 2;
}

std::vector<XrView> views_in_head(const Script& script, XrViewConfigurationType type,
                                  std::optional<glm::dquat> gaze_in_head) {
  const auto radians = [](double degrees) { return static_cast<float>(glm::radians(degrees)); };
  const auto& [left, right, up, down] = script.fov_left;
  std::vector<XrView> views;
  for (std::uint32_t i = 0; i < view_count(type); ++i) {
    const bool right_eye = i % 2 == 1;
    const double side = type == kMono ? 0 : right_eye ? 0.5 : -0.5;
    Pose eye{{side * script.eye_distance_m, 0, 0}, from_degrees(-2 * side * script.cant_deg, 0, 0)};
    XrFovf fov{radians(left), radians(right), radians(up), radians(down)};
    if (right_eye) fov = {radians(-right), radians(-left), fov.angleUp, fov.angleDown};
    if (i >= 2) {
      // About the gaze in the eye's own axes, as an off-axis frustum.
      double yaw = 0, pitch = 0;
      if (gaze_in_head) {
        const glm::dvec3 d = glm::conjugate(eye.rotation) * *gaze_in_head * glm::dvec3(0, 0, -1);
        yaw = glm::degrees(std::atan2(d.x, -d.z));
        pitch = glm::degrees(std::atan2(d.y, -d.z));
      }
      const double half = script.focus_deg;
      fov = {radians(yaw - half), radians(yaw + half), radians(pitch + half),
             radians(pitch - half)};
    }
    views.push_back({XR_TYPE_VIEW, nullptr, to_xr(eye), fov});
  }
  return views;
}

void add_view_functions(Table& table) {
  table.insert(table.end(),
               {NERITIC_XR_ROW(xrEnumerateViewConfigurations, enumerate_configurations, ""),
                NERITIC_XR_ROW(xrGetViewConfigurationProperties, configuration_properties, ""),
                NERITIC_XR_ROW(xrEnumerateViewConfigurationViews, enumerate_views, ""),
                NERITIC_XR_ROW(xrEnumerateEnvironmentBlendModes, enumerate_blend_modes, ""),
                NERITIC_XR_ROW(xrLocateViews, locate_views, ""),
                NERITIC_XR_ROW(xrGetVisibilityMaskKHR, visibility_mask,
                               XR_KHR_VISIBILITY_MASK_EXTENSION_NAME)});
}

}  // namespace neritic::fakes
