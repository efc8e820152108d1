// A pilot and a suit in one struct each, sent to a dive as the samples of one source that then has
// the authority of all those groups for good, or gives it back to the autopilot.
#pragma once

#include <atomic>

#include "diver/frames.hpp"
#include "tests/sim/replay.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {

struct Piloting {
  rov::Vec6 pilot;            // wrench, body axes
  std::uint64_t piloted = 0;  // 0: the mission flies
  std::uint64_t failed_thrusters = 0;
};
struct Suit {
  diver::HumanInputs human;  // without currents
  std::uint64_t worn = 0;    // 0: the autopilot swims
};

// Whether the sample was accepted.
inline bool send(PhysicsSimulation& simulation, StreamId stream, const Payload& payload) {
  static std::atomic<std::uint64_t> sequence{0};
  const SourceId source = simulation.inbox().open("test").value();
  return simulation.inbox().push({{stream, source, ++sequence, 0, 0}, payload}) ==
         SampleVerdict::kAccepted;
}

inline Event hand_over(std::size_t group, Authority authority, SourceId source) {
  return {EventKind::kSetAuthority, group, static_cast<std::uint64_t>(authority), source,
          kHoldForever_s};
}

inline bool pilot(const PhysicsWorld& world, PhysicsSimulation& simulation, std::uint32_t vehicle,
                  const Piloting& piloting) {
  const SourceId source = simulation.inbox().open("test").value();
  const auto say = [&](PayloadKind kind, const Payload& payload) {
    return send(simulation, world.streams().id(OwnerSort::kVehicle, vehicle, kind), payload);
  };
  // A wrench that is not finite is sent alone.
  const VehicleWrench wrench{piloting.pilot};
  if (!all_finite(Payload(wrench))) return say(PayloadKind::kWrench, wrench);
  const Authority by = piloting.piloted ? Authority::kLive : Authority::kAutopilot;
  constexpr auto kWrench = static_cast<std::size_t>(VehicleGroup::kWrench);
  constexpr auto kFault = static_cast<std::size_t>(VehicleGroup::kFault);
  say(PayloadKind::kEvent, hand_over(kWrench, by, source));
  say(PayloadKind::kEvent, hand_over(kFault, Authority::kLive, source));
  say(PayloadKind::kFault, ThrusterFault{piloting.failed_thrusters});
  return say(PayloadKind::kWrench, wrench);
}
inline bool pilot(const TestDive& dive, std::uint32_t vehicle, const Piloting& piloting) {
  return pilot(*dive.world, *dive.simulation, vehicle, piloting);
}

inline bool wear(const PhysicsWorld& world, PhysicsSimulation& simulation, std::uint32_t diver,
                 const Suit& suit) {
  const SourceId source = simulation.inbox().open("test").value();
  const auto say = [&](PayloadKind kind, const Payload& payload) {
    return send(simulation, world.streams().id(OwnerSort::kDiver, diver, kind), payload);
  };
  const diver::HumanInputs& in = suit.human;
  Gaze gaze{in.instruments.gaze};
  gaze.state.direction = diver::world_from_ned(gaze.state.direction);
  gaze.state.fixation = diver::world_from_ned(gaze.state.fixation);
  const Payload payloads[] = {
      BodyJoints{in.joints, in.other_power_w},
      gaze,
      JacketButtons{in.buttons},
      Breath{in.ventilation_l_min, in.breath_bias_m3, in.hold_breath, in.instruments.breath},
      Heart{in.instruments.heart},
      GasSupply{in.tank}};
  const auto kind_of = [](const Payload& payload) {
    return static_cast<PayloadKind>(payload.index());
  };
  // A payload that is not finite is sent alone.
  for (const Payload& payload : payloads)
    if (!all_finite(payload)) return say(kind_of(payload), payload);
  const Authority by = suit.worn ? Authority::kLive : Authority::kAutopilot;
  for (const DiverGroup group : {DiverGroup::kBody, DiverGroup::kGaze, DiverGroup::kButtons,
                                 DiverGroup::kBreath, DiverGroup::kHeart, DiverGroup::kGas})
    say(PayloadKind::kEvent, hand_over(static_cast<std::size_t>(group), by, source));
  bool accepted = true;
  for (const Payload& payload : payloads) accepted &= say(kind_of(payload), payload);
  return accepted;
}
inline bool wear(const TestDive& dive, std::uint32_t diver, const Suit& suit) {
  return wear(*dive.world, *dive.simulation, diver, suit);
}

// Inputs that hold a wrench for good.
inline VehicleInputs held(const Piloting& piloting) {
  VehicleInputs inputs = autopilot_vehicle();
  const GroupControl live{.authority = Authority::kLive, .heard = 1};
  if (piloting.piloted) inputs.of(VehicleGroup::kWrench) = live;
  inputs.of(VehicleGroup::kFault) = live;
  inputs.wrench.wrench = piloting.pilot;
  inputs.fault.failed = piloting.failed_thrusters;
  return inputs;
}

// Runs a dive's log again.
inline sim::ReplayReport replayed(const PhysicsWorld& world, const PhysicsSimulation::Log& log) {
  return sim::test::replay(log, world.start(), world.step_function(),
                           [&](PhysicsInputs& inputs, const Sample& sample, std::uint64_t step) {
                             world.apply(inputs, sample, step);
                           });
}

}  // namespace neritic::testbed
