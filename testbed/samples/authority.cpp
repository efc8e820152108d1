#include "testbed/samples/authority.hpp"

namespace neritic::testbed {
namespace {

constexpr std::array<std::string_view, kAuthorities> kAuthorityNames{"nobody", "autopilot",
                                                                     "recording", "live"};
constexpr std::array<std::string_view, kDiverGroups> kDiverGroupNames{
    "body", "hands", "head", "gaze", "buttons", "breath", "heart", "gas"};
constexpr std::array<std::string_view, kVehicleGroups> kVehicleGroupNames{"wrench", "setpoint",
                                                                          "fault"};

constexpr std::array<std::string_view, 4> kPhaseNames{"chosen", "waiting", "live", "lost"};

}  // namespace

std::string_view name_of(GroupPhase phase) {
  return kPhaseNames.at(static_cast<std::size_t>(phase));
}
std::string_view name_of(Authority authority) {
  return kAuthorityNames.at(static_cast<std::size_t>(authority));
}
std::string_view name_of(DiverGroup group) {
  return kDiverGroupNames.at(static_cast<std::size_t>(group));
}
std::string_view name_of(VehicleGroup group) {
  return kVehicleGroupNames.at(static_cast<std::size_t>(group));
}

std::string_view name_of(ObjectGroup) {
  return "pose";
}

std::optional<std::size_t> group_of(PayloadKind kind) {
  const auto diver = [](DiverGroup group) { return static_cast<std::size_t>(group); };
  const auto vehicle = [](VehicleGroup group) { return static_cast<std::size_t>(group); };
  switch (kind) {
    case PayloadKind::kBodyJoints:
      return diver(DiverGroup::kBody);
    case PayloadKind::kHandJoints:
    case PayloadKind::kHandPoses:
      return diver(DiverGroup::kHands);
    case PayloadKind::kHeadPose:
      return diver(DiverGroup::kHead);
    case PayloadKind::kGaze:
      return diver(DiverGroup::kGaze);
    case PayloadKind::kButtons:
      return diver(DiverGroup::kButtons);
    case PayloadKind::kBreath:
      return diver(DiverGroup::kBreath);
    case PayloadKind::kHeart:
      return diver(DiverGroup::kHeart);
    case PayloadKind::kGas:
      return diver(DiverGroup::kGas);
    case PayloadKind::kWrench:
    case PayloadKind::kThrusters:
      return vehicle(VehicleGroup::kWrench);
    case PayloadKind::kSetpoint:
    case PayloadKind::kVelocity:
      return vehicle(VehicleGroup::kSetpoint);
    case PayloadKind::kFault:
      return vehicle(VehicleGroup::kFault);
    case PayloadKind::kObjectPose:
      return static_cast<std::size_t>(ObjectGroup::kPose);
    default:
      return std::nullopt;
  }
}

bool hear(GroupControl& control, SourceId source, std::uint64_t step) {
  if (control.authority != Authority::kLive || control.source != source) {
    ++control.unheeded;
    control.unheeded_source = source;
    return false;
  }
  ++control.heard;
  control.heard_step = step;
  return true;
}

bool set_authority(GroupControl& control, std::uint64_t authority, std::uint64_t source) {
  if (authority >= kAuthorities) return false;
  control.authority = static_cast<Authority>(authority);
  control.source = source;
  control.heard = control.heard_step = 0;
  return true;
}

GroupState next_group(const GroupState& before, const GroupControl& control, std::uint64_t step,
                      double dt_s) {
  GroupState next = before;
  next.authority = control.authority;
  next.then = control.then;
  next.source = control.source;
  next.heard = control.heard;
  next.unheeded = control.unheeded;
  next.unheeded_source = control.unheeded_source;
  if (control.authority != Authority::kLive) {
    next.phase = GroupPhase::kChosen;
  } else if (control.heard == 0) {
    next.phase = GroupPhase::kWaiting;
  } else {
    const double silent_s = static_cast<double>(step - control.heard_step) * dt_s;
    next.phase = silent_s <= control.hold_s ? GroupPhase::kLive : GroupPhase::kLost;
  }
  if (next.phase == GroupPhase::kLost && before.phase != GroupPhase::kLost) ++next.losses;
  return next;
}

Authority acting(const GroupControl& control, GroupPhase phase) {
  return phase == GroupPhase::kWaiting || phase == GroupPhase::kLost ? control.then
                                                                     : control.authority;
}

Authority acting(const GroupState& state) {
  return acting(GroupControl{.authority = state.authority, .then = state.then}, state.phase);
}

}  // namespace neritic::testbed
