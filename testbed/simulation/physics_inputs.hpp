// The inputs of a scene's vehicles, divers and tracked objects, and the rule that a scene gives for
// each group of them. One block of plain structs (testbed/samples/group_inputs.hpp). Any thread.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "engine/scene/physics_settings.hpp"
#include "engine/sim/block.hpp"
#include "testbed/samples/group_inputs.hpp"

namespace neritic::testbed {

// Messages that wait for a modem, which handles kInStep of them a step: with all else that may
// happen to it in a step their reports fit in its ring (sonar::ModemState::kKept).
struct ModemQueue {
  static constexpr std::uint64_t kMost = 32, kInStep = 4;
  std::uint64_t waiting = 0, at_step = 0;

  // Another one before this step. False: as many as fit wait already.
  bool add(std::uint64_t step) {
    const std::uint64_t steps = step > at_step ? step - at_step : 0;
    waiting -= std::min(waiting, kInStep * std::min(steps, kMost));
    at_step = step;
    if (waiting == kMost) return false;
    ++waiting;
    return true;
  }

  static void fields(auto&& field, auto& self) {
    field("waiting", self.waiting);
    field("at_step", self.at_step);
  }
};

// Messages that a modem was asked to send; the state counts those that it has handled.
struct ModemInputs {
  std::uint64_t asked = 0;
  std::uint64_t crowded_out = 0;  // refused: the queue was full
  ModemQueue queue;
  std::array<ModemSend, ModemQueue::kMost> messages{};  // a ring: message k is at k % kMost

  void add(const ModemSend& message, std::uint64_t step) {
    if (queue.add(step))
      messages[asked++ % ModemQueue::kMost] = message;
    else
      ++crowded_out;
  }

  static void fields(auto&& field, auto& self) {
    field("asked", self.asked);
    field("crowded_out", self.crowded_out);
    field("queue", self.queue);
    field("messages", self.messages);
  }
};

// The newest word about a diver's regulators; it holds.
struct RegulatorInputs {
  RegulatorUse use;

  static void fields(auto&& field, auto& self) { field("use", self.use); }
};

// The newest word about a grip; it holds.
struct GripInputs {
  GripUse use;

  static void fields(auto&& field, auto& self) { field("use", self.use); }
};

// The inputs of every vehicle, diver and object that devices move, of every modem, and of the
// regulators, grips and limbs that the scene names.
class PhysicsInputs : public sim::Block<VehicleInputs, DiverInputs, ObjectInputs, ModemInputs,
                                        RegulatorInputs, GripInputs, LimbTrack> {
 public:
  PhysicsInputs() = default;
  PhysicsInputs(std::size_t vehicles, std::size_t humans, std::size_t objects = 0,
                std::size_t modems = 0, std::size_t regulators = 0, std::size_t grips = 0,
                std::size_t limbs = 0)
      : Block({vehicles, humans, objects, modems, regulators, grips, limbs}) {}

  std::span<VehicleInputs> vehicles() { return part<VehicleInputs>(); }
  std::span<const VehicleInputs> vehicles() const { return part<VehicleInputs>(); }
  std::span<DiverInputs> humans() { return part<DiverInputs>(); }
  std::span<const DiverInputs> humans() const { return part<DiverInputs>(); }
  std::span<ObjectInputs> objects() { return part<ObjectInputs>(); }
  std::span<const ObjectInputs> objects() const { return part<ObjectInputs>(); }
  std::span<ModemInputs> modems() { return part<ModemInputs>(); }
  std::span<const ModemInputs> modems() const { return part<ModemInputs>(); }
  // For the objects that have limbs, in their order.
  std::span<LimbTrack> limbs() { return part<LimbTrack>(); }
  std::span<const LimbTrack> limbs() const { return part<LimbTrack>(); }

  std::span<RegulatorInputs> regulators() { return part<RegulatorInputs>(); }
  std::span<const RegulatorInputs> regulators() const { return part<RegulatorInputs>(); }

  std::span<GripInputs> grips() { return part<GripInputs>(); }
  std::span<const GripInputs> grips() const { return part<GripInputs>(); }

  static void fields(auto&& field, auto& self) {
    auto vehicles = self.vehicles();
    auto humans = self.humans();
    auto objects = self.objects();
    auto modems = self.modems();
    auto limbs = self.limbs();
    field("vehicles", vehicles);
    field("humans", humans);
    field("objects", objects);
    field("modems", modems);
    auto regulators = self.regulators();
    field("regulators", regulators);
    auto grips = self.grips();
    field("grips", grips);
    field("limbs", limbs);
  }
};

// The names of a scene's live sources. The first has the SourceId 1: an inbox opens them in order.
using SourceNames = std::vector<std::string>;

// The inputs of a participant at the start, as the scene chooses; names not yet in sources are
// added. recorded_*: whether the scene names a file for that group.
VehicleInputs chosen_inputs(const std::vector<scene::InputChoice>& choices, SourceNames& sources);
ObjectInputs chosen_object_inputs(const std::vector<scene::InputChoice>& choices,
                                  SourceNames& sources);
DiverInputs chosen_inputs(const std::vector<scene::InputChoice>& choices, bool recorded_body,
                          bool recorded_buttons, SourceNames& sources);

}  // namespace neritic::testbed
