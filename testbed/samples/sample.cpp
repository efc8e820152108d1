#include "testbed/samples/sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <span>
#include <utility>

#include "engine/sim/fields.hpp"
#include "testbed/samples/unit_rotation.hpp"

namespace neritic::testbed {
namespace {

constexpr std::array<std::string_view, kPayloadKinds> kKindNames{
    "joints", "hands",     "hand_poses", "head",     "gaze",     "buttons",   "breath",
    "heart",  "gas",       "wrench",     "setpoint", "velocity", "thrusters", "fault",
    "pose",   "event",     "imu",        "dvl",      "pressure", "compass",   "altimeter",
    "usbl",   "collision", "motion",     "computer", "modem",    "send",      "condition",
    "supply", "regulator", "gripper",    "grip",     "tether",   "battery",   "human"};

template <std::size_t... index>
Payload make_payload(std::size_t kind, std::index_sequence<index...>) {
  Payload payload;
  ((kind == index ? void(payload.emplace<index>()) : void()), ...);
  return payload;
}

bool within(const Vec3& v, double most) {
  return std::abs(v.x) <= most && std::abs(v.y) <= most && std::abs(v.z) <= most;
}

// The poses and rotations in value, at any depth.
template <class T>
bool plausible_in(const T& value) {
  if constexpr (std::same_as<T, Quat>) {
    return is_unit_rotation(value);
  } else if constexpr (std::same_as<T, Pose>) {
    return within(value.position_m, kFarthest_m) && is_unit_rotation(value.rotation);
  } else if constexpr (sim::Scalar<T> || std::is_enum_v<T>) {
    return true;
  } else {
    bool good = true;
    sim::for_each_part(value, [&](const auto&, const auto& part) { good &= plausible_in(part); });
    return good;
  }
}

bool plausible_in(const HandPoses& hands) {
  for (std::size_t i = 0; i < 2; ++i)
    if ((hands.tracked >> i & 1) != 0 && !plausible_in(hands.world_from_hand[i])) return false;
  return true;
}

bool plausible_in(const ObjectPose& object) {
  return plausible_in(object.world_from_object) &&
         (object.measured == 0 || (within(object.velocity_m_s, kFastest) &&
                                   within(object.angular_velocity_rad_s, kFastest)));
}

bool plausible_in(const VehicleSetpoint& setpoint) {
  return within(setpoint.position_m, kFarthest_m) && within(setpoint.velocity_m_s, kFastest);
}

bool plausible_in(const VehicleVelocity& wanted) {
  return within(wanted.velocity_m_s, kFastest) && std::abs(wanted.yaw_rate_rad_s) <= kFastest;
}

bool strong_at_most(std::span<const double> values) {
  return std::ranges::all_of(values, [](double v) { return std::abs(v) <= kStrongest; });
}

bool plausible_in(const VehicleWrench& wanted) {
  return strong_at_most(wanted.wrench.v);
}

bool plausible_in(const VehicleThrusters& wanted) {
  return strong_at_most(wanted.force_n);
}

}  // namespace

std::string_view name_of(PayloadKind kind) {
  return kKindNames.at(static_cast<std::size_t>(kind));
}

Payload empty_payload(PayloadKind kind) {
  NERITIC_CHECK(static_cast<std::size_t>(kind) < kPayloadKinds, "kind {}",
                static_cast<std::uint32_t>(kind));
  return make_payload(static_cast<std::size_t>(kind), std::make_index_sequence<kPayloadKinds>{});
}

bool all_finite(const Payload& payload) {
  return std::visit([](const auto& value) { return sim::all_finite(value); }, payload);
}

bool plausible(const Payload& payload) {
  return std::visit([](const auto& value) { return plausible_in(value); }, payload);
}

}  // namespace neritic::testbed
