// Spaces and where they are.
#include <fmt/format.h>

#include <cmath>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

constexpr auto kView = XR_REFERENCE_SPACE_TYPE_VIEW;
constexpr auto kLocal = XR_REFERENCE_SPACE_TYPE_LOCAL;
constexpr auto kStage = XR_REFERENCE_SPACE_TYPE_STAGE;
constexpr auto kCombinedEye = XR_REFERENCE_SPACE_TYPE_COMBINED_EYE_VARJO;

std::vector<XrReferenceSpaceType> reference_spaces(Call& call) {
  std::vector<XrReferenceSpaceType> types{kView, kLocal};
  if (call.rt.script.stage) types.push_back(kStage);
  if (call.enabled(XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME)) types.push_back(kCombinedEye);
  return types;
}

void check_reference(Call& call, XrReferenceSpaceType type) {
  const auto types = reference_spaces(call);
  call.require(std::find(types.begin(), types.end(), type) != types.end(),
               XR_ERROR_REFERENCE_SPACE_UNSUPPORTED,
               "the type of space is not among xrEnumerateReferenceSpaces");
}

XrResult enumerate_spaces(Call& call, XrSession handle, std::uint32_t capacity,
                          std::uint32_t* count, XrReferenceSpaceType* types) {
  call.get<Session>(handle);
  call.fill(capacity, count, types, reference_spaces(call));
  return XR_SUCCESS;
}

XrResult create_reference_space(Call& call, XrSession handle,
                                const XrReferenceSpaceCreateInfo* create, XrSpace* made) {
  Session& session = call.get<Session>(handle);
  const auto& info = call.in(create);
  call.not_null(made, "the space");
  check_reference(call, info.referenceSpaceType);
  call.check_pose(info.poseInReferenceSpace);
  Space& space = call.add<Space>(&session);
  space.reference = info.referenceSpaceType;
  space.offset = from_xr(info.poseInReferenceSpace);
  *made = handle_of(space);
  return XR_SUCCESS;
}

XrResult bounds(Call& call, XrSession handle, XrReferenceSpaceType type, XrExtent2Df* to) {
  call.get<Session>(handle);
  check_reference(call, type);
  *call.not_null(to, "the bounds") = {0, 0};
  if (type != kStage) return XR_SPACE_BOUNDS_UNAVAILABLE;
  *to = {3, 2};
  return XR_SUCCESS;
}

XrResult destroy_space(Call& call, XrSpace handle) {
  call.rt.destroy(call.get_to_destroy<Space>(handle));
  return XR_SUCCESS;
}

void put(XrVector3f& to, const glm::dvec3& from) {
  to = {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)};
}

// By differences over 2 ms, in the axes of the base.
void put_velocity(Runtime& rt, const Space& space, const Space& base, XrTime time,
                  XrSpaceVelocity& to) {
  constexpr XrTime kHalf = 1'000'000;
  const auto relative = [&](XrTime at) {
    return inverse(locate(rt, base, at).pose) * locate(rt, space, at).pose;
  };
  const Pose before = relative(time - kHalf), after = relative(time + kHalf);
  put(to.linearVelocity, (after.position - before.position) / 0.002);
  glm::dquat turn = after.rotation * glm::conjugate(before.rotation);
  if (turn.w < 0) turn = -turn;
  put(to.angularVelocity, glm::axis(turn) * glm::angle(turn) / 0.002);
  to.velocityFlags = XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT;
}

XrResult locate_space(Call& call, XrSpace handle, XrSpace base_handle, XrTime time,
                      XrSpaceLocation* location) {
  const Space& space = call.get<Space>(handle);
  const Space& base = call.get<Space>(base_handle);
  XrSpaceLocation& to = call.out(
      location, {{XR_TYPE_SPACE_VELOCITY},
                 {XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT, XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME}});
  call.require(&space.session == &base.session, XR_ERROR_VALIDATION_FAILURE,
               "the two spaces belong to different sessions");
  call.check_time(time);
  const Located there = locate(call.rt, space, time), from = locate(call.rt, base, time);
  to.locationFlags = 0;
  auto* velocity = Call::chained<XrSpaceVelocity>(to.next);
  if (velocity) velocity->velocityFlags = 0;
  auto* sample = Call::chained<XrEyeGazeSampleTimeEXT>(to.next);
  if (sample) sample->time = there.sample_time;
  if (!there.oriented || !from.oriented) return XR_SUCCESS;
  to.pose = to_xr(inverse(from.pose) * there.pose);
  to.locationFlags |= XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  if (there.positioned && from.positioned) {
    to.locationFlags |= XR_SPACE_LOCATION_POSITION_VALID_BIT;
  } else {
    to.pose.position = kUnknown;
  }
  if (there.tracked && from.tracked) {
    to.locationFlags |=
        XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
    if (velocity) put_velocity(call.rt, space, base, time, *velocity);
  }
  return XR_SUCCESS;
}

}  // namespace

Located locate_view_space(Runtime& rt, XrTime time) {
  const double time_s = rt.seconds(time);
  Pose head = rt.script.head.empty() ? Pose{{0, 1.7, 0}, {1, 0, 0, 0}} : rt.script.head.at(time_s);
  const bool* tracked = rt.script.tracked.at(time_s);
  // Without tracking the pose of the moment it was lost is still given, as not tracked.
  if (tracked && !*tracked)
    return {rt.script.head.at(rt.script.tracked.since(time_s)), true, true, false};
  const bool *oriented = rt.script.oriented.at(time_s),
             *positioned = rt.script.positioned.at(time_s);
  const bool turned = !oriented || *oriented, placed = !positioned || *positioned;
  return {head, turned, placed, turned && placed};
}

Located locate_gaze(Runtime& rt, XrTime time) {
  const auto step = static_cast<XrTime>(std::llround(rt.script.gaze_period_s * 1e9));
  const XrTime sample = kEpoch + (std::min(time, rt.now) - kEpoch) / step * step;
  Located at = locate_view_space(rt, sample);
  at.pose = at.pose * rt.script.gaze.at(rt.seconds(sample));
  at.sample_time = sample;
  return at;
}

Located locate(Runtime& rt, const Space& space, XrTime time) {
  Located at;
  if (space.action != 0) {
    at = locate_action(rt, space, time);
  } else if (space.reference == kView) {
    at = locate_view_space(rt, time);
  } else if (space.reference == kLocal) {
    at.pose = rt.script.local;
  } else if (space.reference == kCombinedEye) {
    at = locate_view_space(rt, time);
    at.tracked = at.tracked && !rt.script.gaze.empty();
    at.pose = at.pose * rt.script.gaze.at(rt.seconds(time));
  }
  at.pose = at.pose * space.offset;
  return at;
}

void add_space_functions(Table& table) {
  table.insert(table.end(), {NERITIC_XR_ROW(xrEnumerateReferenceSpaces, enumerate_spaces, ""),
                             NERITIC_XR_ROW(xrCreateReferenceSpace, create_reference_space, ""),
                             NERITIC_XR_ROW(xrGetReferenceSpaceBoundsRect, bounds, ""),
                             NERITIC_XR_ROW(xrDestroySpace, destroy_space, ""),
                             NERITIC_XR_ROW(xrLocateSpace, locate_space, "")});
}

}  // namespace neritic::fakes
