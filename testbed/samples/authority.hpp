// The source that each group of a participant's inputs listens to. Every group has one authority at
// a time; the scene chooses it, an event changes it. A live source that falls silent holds its
// newest value for `hold_s`, then `then` acts until it is heard again. Pure functions over plain
// bytes: the control is part of a step's inputs, the state part of its state, so a replay repeats
// both.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "testbed/samples/sample.hpp"

namespace neritic::testbed {

enum class Authority : std::uint64_t {
  kNobody,     // the group rests: limbs keep their posture, no button is pressed, objects stay
  kAutopilot,  // the swimmer, the mission, the effort's own breath and heart, an object's track
  kRecording,  // a file of the scene
  kLive,       // samples of one source
};
inline constexpr std::uint64_t kAuthorities = 4;
std::string_view name_of(Authority authority);

enum class DiverGroup : std::uint64_t {
  kBody,
  kHands,
  kHead,
  kGaze,
  kButtons,
  kBreath,
  kHeart,
  kGas
};
inline constexpr std::size_t kDiverGroups = 8;
enum class VehicleGroup : std::uint64_t { kWrench, kSetpoint, kFault };
inline constexpr std::size_t kVehicleGroups = 3;
enum class ObjectGroup : std::uint64_t { kPose };
inline constexpr std::size_t kObjectGroups = 1;
std::string_view name_of(DiverGroup group);
std::string_view name_of(VehicleGroup group);
std::string_view name_of(ObjectGroup group);
// The group that a kind of sample feeds, as its number; none for outputs and events.
std::optional<std::size_t> group_of(PayloadKind kind);

// For as long as this a silent source's newest value holds, unless the scene says otherwise: limbs
// and hands that stop must not freeze a swimmer for long, a strap speaks once a second and breath
// is analysed in blocks of 10 s (diver/vitals.cpp), faults and tanks stay until they change.
inline constexpr double kHoldForever_s = 1e9;
inline constexpr std::array<double, kDiverGroups> kDiverHold_s{0.5, 0.5,  0.5,  1.0,
                                                               0.5, 30.0, 10.0, kHoldForever_s};
inline constexpr std::array<double, kVehicleGroups> kVehicleHold_s{0.5, 0.5, kHoldForever_s};
inline constexpr std::array<double, kObjectGroups> kObjectHold_s{0.5};

// The source that a group is to listen to, and the samples that came for it.
struct GroupControl {
  Authority authority = Authority::kAutopilot;
  Authority then = Authority::kAutopilot;  // while a live source is silent; never kLive
  std::uint64_t source = 0;                // of kLive
  double hold_s = kHoldForever_s;
  std::uint64_t heard = 0;            // samples of the source
  std::uint64_t heard_step = 0;       // the step that used the newest first
  std::uint64_t unheeded = 0;         // samples of any other source
  std::uint64_t unheeded_source = 0;  // of the newest of those

  static void fields(auto&& field, auto& self) {
    field("authority", self.authority);
    field("then", self.then);
    field("source", self.source);
    field("hold_s", self.hold_s);
    field("heard", self.heard);
    field("heard_step", self.heard_step);
    field("unheeded", self.unheeded);
    field("unheeded_source", self.unheeded_source);
  }
};

// A sample for the group came before step. Whether it counts.
bool hear(GroupControl& control, SourceId source, std::uint64_t step);
// False, and no change, where the numbers name no authority.
bool set_authority(GroupControl& control, std::uint64_t authority, std::uint64_t source);

enum class GroupPhase : std::uint64_t {
  kChosen,   // the authority is not a live one
  kWaiting,  // the source was never heard
  kLive,
  kLost,  // the source is silent for longer than hold_s
};
std::string_view name_of(GroupPhase phase);

// With the control of the newest step beside it, so that a snapshot says who has the authority.
struct GroupState {
  GroupPhase phase = GroupPhase::kChosen;
  std::uint64_t losses = 0;  // times that the source fell silent
  Authority authority = Authority::kAutopilot, then = Authority::kAutopilot;
  std::uint64_t source = 0;
  std::uint64_t heard = 0, unheeded = 0, unheeded_source = 0;
  std::uint64_t jumps = 0;  // of limbs, from one sample to the next (simulation/joint_ease.hpp)

  static void fields(auto&& field, auto& self) {
    fields_but_sources(field, self);
    field("source", self.source);
    field("unheeded_source", self.unheeded_source);
    field("jumps", self.jumps);
  }
  // Without numbers that depend on the order in which sources were opened.
  static void fields_but_sources(auto&& field, auto& self) {
    field("phase", self.phase);
    field("losses", self.losses);
    field("authority", self.authority);
    field("then", self.then);
    field("heard", self.heard);
    field("unheeded", self.unheeded);
  }
};

// The source of a dive's own keys.
inline constexpr std::string_view kKeyboard = "keyboard";

// In step `step`, which lasts dt_s.
GroupState next_group(const GroupState& before, const GroupControl& control, std::uint64_t step,
                      double dt_s);
// The authority that acts on the group in that phase: kLive only while the source is heard.
Authority acting(const GroupControl& control, GroupPhase phase);
Authority acting(const GroupState& state);
// Bit i: group i waits for its source, or lost it.
template <class Groups>
std::uint64_t silent_groups(const Groups& groups) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (groups[i].phase == GroupPhase::kWaiting || groups[i].phase == GroupPhase::kLost)
      bits |= std::uint64_t{1} << i;
  return bits;
}

}  // namespace neritic::testbed
