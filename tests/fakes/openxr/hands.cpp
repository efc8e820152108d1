// XR_EXT_hand_tracking: 26 joints of a stiff hand that can close, about the script's wrist.
#include <fmt/format.h>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

// A finger of the right hand, in the wrist's axes (x right, y out of the back, -z to the fingers).
// Round numbers of a grown hand, metres.
struct Finger {
  glm::dvec3 base;    // of the metacarpal (of the thumb, too)
  double metacarpal;  // length
  double lengths[3];  // of the phalanges; the thumb has two
  double yaw_deg;     // of the whole finger, to the left
};
constexpr Finger kFingers[] = {{{-0.025, 0, -0.015}, 0.045, {0.035, 0.027, 0}, 40},
                               {{-0.020, 0, -0.020}, 0.070, {0.045, 0.026, 0.022}, 4},
                               {{-0.005, 0, -0.020}, 0.068, {0.050, 0.030, 0.024}, 0},
                               {{0.010, 0, -0.020}, 0.063, {0.046, 0.028, 0.024}, -4},
                               {{0.022, 0, -0.020}, 0.058, {0.036, 0.021, 0.021}, -8}};
constexpr double kBend_deg = 85;  // of each joint in a fist

using Joints = std::array<Pose, XR_HAND_JOINT_COUNT_EXT>;

Joints joints_at(const Runtime& rt, std::size_t side, XrTime time) {
  const double time_s = rt.seconds(time);
  const Pose wrist = rt.script.hands[side].at(time_s);
  const double* curl = rt.script.curls[side].at(time_s);
  const double bend = -kBend_deg * (curl ? *curl : 0);
  const double mirror = side == 0 ? -1 : 1;
  const auto ahead = [](double length) { return Pose{{0, 0, -length}, {1, 0, 0, 0}}; };
  Joints joints;
  joints[XR_HAND_JOINT_WRIST_EXT] = wrist;
  joints[XR_HAND_JOINT_PALM_EXT] = wrist * Pose{{-0.005 * mirror, 0, -0.054}, {1, 0, 0, 0}};
  std::size_t joint = XR_HAND_JOINT_THUMB_METACARPAL_EXT;
  for (const Finger& finger : kFingers) {
    Pose at = wrist * Pose{{finger.base.x * mirror, finger.base.y, finger.base.z},
                           from_degrees(finger.yaw_deg * mirror, 0, 0)};
    joints[joint++] = at;
    at = at * ahead(finger.metacarpal);
    for (const double length : finger.lengths) {
      if (length == 0) continue;
      at = at * Pose{{}, from_degrees(0, bend, 0)};
      joints[joint++] = at;
      at = at * ahead(length);
    }
    joints[joint++] = at;  // the tip
  }
  return joints;
}

XrResult create_tracker(Call& call, XrSession handle, const XrHandTrackerCreateInfoEXT* create,
                        XrHandTrackerEXT* made) {
  Session& session = call.get<Session>(handle);
  const auto& info = call.in(create);
  const auto& hands = call.rt.script.hands;
  if (hands[0].empty() && hands[1].empty()) call.refuse(XR_ERROR_FEATURE_UNSUPPORTED);
  call.require(info.hand == XR_HAND_LEFT_EXT || info.hand == XR_HAND_RIGHT_EXT,
               XR_ERROR_VALIDATION_FAILURE, "the hand is neither left nor right");
  call.require(info.handJointSet == XR_HAND_JOINT_SET_DEFAULT_EXT, XR_ERROR_VALIDATION_FAILURE,
               "handJointSet is not the default");
  HandTracker& tracker = call.add<HandTracker>(&session);
  tracker.side = info.hand == XR_HAND_RIGHT_EXT;
  *call.not_null(made, "the hand tracker") = handle_of(tracker);
  return XR_SUCCESS;
}

XrResult destroy_tracker(Call& call, XrHandTrackerEXT handle) {
  call.rt.destroy(call.get_to_destroy<HandTracker>(handle));
  return XR_SUCCESS;
}

XrVector3f to_vector(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

void put_velocities(Call& call, const HandTracker& tracker, const Pose& world_from_base,
                    XrTime time, XrHandJointVelocitiesEXT& to) {
  call.require(to.jointCount == XR_HAND_JOINT_COUNT_EXT, XR_ERROR_VALIDATION_FAILURE,
               "jointCount of the velocities is not 26");
  constexpr XrTime kHalf = 1'000'000;
  const Joints before = joints_at(call.rt, tracker.side, time - kHalf);
  const Joints after = joints_at(call.rt, tracker.side, time + kHalf);
  const glm::dquat base_from_world = glm::conjugate(world_from_base.rotation);
  for (std::size_t i = 0; i < before.size(); ++i) {
    glm::dquat turn = after[i].rotation * glm::conjugate(before[i].rotation);
    if (turn.w < 0) turn = -turn;
    XrHandJointVelocityEXT& one = to.jointVelocities[i];
    one.velocityFlags = XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT;
    one.linearVelocity =
        to_vector(base_from_world * (after[i].position - before[i].position) / 0.002);
    one.angularVelocity = to_vector(base_from_world * glm::axis(turn) * glm::angle(turn) / 0.002);
  }
}

XrResult locate_joints(Call& call, XrHandTrackerEXT handle,
                       const XrHandJointsLocateInfoEXT* locate_info,
                       XrHandJointLocationsEXT* locations) {
  const HandTracker& tracker = call.get<HandTracker>(handle);
  const auto& info = call.in(locate_info);
  XrHandJointLocationsEXT& to = call.out(locations, {{XR_TYPE_HAND_JOINT_VELOCITIES_EXT}});
  const Space& base = call.get<Space>(info.baseSpace);
  call.require(&base.session == &tracker.session, XR_ERROR_VALIDATION_FAILURE,
               "the base space belongs to another session");
  call.check_time(info.time);
  call.require(to.jointCount == XR_HAND_JOINT_COUNT_EXT, XR_ERROR_VALIDATION_FAILURE,
               fmt::format("jointCount is {}; it must be 26", to.jointCount));
  call.not_null(to.jointLocations, "jointLocations");
  auto* velocities = Call::chained<XrHandJointVelocitiesEXT>(to.next);
  to.isActive = !call.rt.script.hands[tracker.side].empty() && call.rt.script.hands_seen;
  for (std::uint32_t i = 0; i < to.jointCount; ++i) to.jointLocations[i].locationFlags = 0;
  if (!to.isActive) return XR_SUCCESS;
  const Pose world_from_base = locate(call.rt, base, info.time).pose;
  const Joints joints = joints_at(call.rt, tracker.side, info.time);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    to.jointLocations[i] = {
        XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT |
            XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT,
        to_xr(inverse(world_from_base) * joints[i]), 0.01f};
  }
  if (velocities) put_velocities(call, tracker, world_from_base, info.time, *velocities);
  return XR_SUCCESS;
}

}  // namespace

void add_hand_functions(Table& table) {
  const char* extension = XR_EXT_HAND_TRACKING_EXTENSION_NAME;
  table.insert(table.end(), {NERITIC_XR_ROW(xrCreateHandTrackerEXT, create_tracker, extension),
                             NERITIC_XR_ROW(xrDestroyHandTrackerEXT, destroy_tracker, extension),
                             NERITIC_XR_ROW(xrLocateHandJointsEXT, locate_joints, extension)});
}

}  // namespace neritic::fakes
