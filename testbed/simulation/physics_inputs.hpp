// What acts on a scene's vehicles and divers from outside, and the messages that change it. Plain
// structs that list their fields; NED and forward, starboard, down (rov/). Any thread.
#pragma once

#include <cstdint>

#include "diver/human_state.hpp"
#include "engine/sim/block.hpp"
#include "rov/dynamics.hpp"

namespace neritic::testbed {

// From outside, for one vehicle.
struct VehicleInputs {
  // While piloted, instead of the mission: a wrench, body axes, scaled down to the room that the
  // thrusters have for it; depth and heading are held where the wrench leaves them alone.
  rov::Vec6 pilot;
  std::uint64_t piloted = 0;           // 0 or 1
  std::uint64_t failed_thrusters = 0;  // bits

  static void fields(auto&& field, auto& self) {
    field("pilot", self.pilot);
    field("piloted", self.piloted);
    field("failed_thrusters", self.failed_thrusters);
  }
};

// From outside, for one diver.
struct HumanSteering {
  // Joints, breath, buttons and tank of a person. While worn is 0 they are the swimmer's own; the
  // tank only where the diver's file plans gas switches. Currents are the scene's.
  diver::HumanInputs human;
  std::uint64_t worn = 0;  // 0 or 1

  static void fields(auto&& field, auto& self) {
    field("human", self.human);
    field("worn", self.worn);
  }
};

// The inputs of every vehicle and diver of a scene.
class PhysicsInputs : public sim::Block<VehicleInputs, HumanSteering> {
 public:
  PhysicsInputs() = default;
  PhysicsInputs(std::size_t vehicles, std::size_t humans) : Block({vehicles, humans}) {}

  std::span<VehicleInputs> vehicles() { return part<VehicleInputs>(); }
  std::span<const VehicleInputs> vehicles() const { return part<VehicleInputs>(); }
  std::span<HumanSteering> humans() { return part<HumanSteering>(); }
  std::span<const HumanSteering> humans() const { return part<HumanSteering>(); }

  static void fields(auto&& field, auto& self) {
    auto vehicles = self.vehicles();
    auto humans = self.humans();
    field("vehicles", vehicles);
    field("humans", humans);
  }
};

// New inputs of one vehicle or of one diver; ignored where the scene has no such number.
struct PhysicsMessage {
  std::uint64_t vehicle = 0;
  VehicleInputs inputs;
  std::uint64_t is_human = 0;  // 1: the number is a diver's, and steering counts
  HumanSteering steering;

  static void fields(auto&& field, auto& self) {
    field("vehicle", self.vehicle);
    field("inputs", self.inputs);
    field("is_human", self.is_human);
    field("steering", self.steering);
  }
};

}  // namespace neritic::testbed
