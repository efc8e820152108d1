// What changes while a scene's vehicles move, as plain bytes: the state of a simulation
// (engine/sim/simulation.hpp), what steers it from outside, and the messages that change that. NED
// and forward, starboard, down (rov/). Any thread.
#pragma once

#include <array>
#include <cstdint>

#include "diver/gas_switch.hpp"
#include "diver/human_step.hpp"
#include "diver/swimmer.hpp"
#include "engine/sim/simulation.hpp"
#include "rov/dynamics.hpp"

namespace neritic::testbed {

// So that a state can be copied as bytes.
inline constexpr std::size_t kMaxVehicles = 4;
inline constexpr std::size_t kMaxHumans = 2;

// How far a mission is.
struct MissionState {
  std::uint64_t arrived = 0, left = 0;  // waypoints, all rounds together
  double arrived_s = 0.0;               // when it came to the one where it holds
  Vec3 leg_from_ned_m{0.0};             // where the way to the next one begins
  std::uint64_t piloted = 0;            // 1: a pilot flew at the last control period
  // What the controller holds.
  Vec3 wanted_ned_m{0.0};
  Quat wanted_attitude{1.0, 0.0, 0.0, 0.0};

  static void fields(auto&& field, auto& self) {
    field("arrived", self.arrived);
    field("left", self.left);
    field("arrived_s", self.arrived_s);
    field("leg_from_ned_m", self.leg_from_ned_m);
    field("piloted", self.piloted);
    field("wanted_ned_m", self.wanted_ned_m);
    field("wanted_attitude", self.wanted_attitude);
  }
};

struct ContactState {
  std::uint64_t near_points = 0;    // in the last step
  std::uint64_t touched_steps = 0;  // so far
  double deepest_m = 0.0;           // so far
  Vec3 impulse_n_s{0.0};            // of the last step, world axes
  // Rate of the velocity by contacts alone, mean of the last step; a vehicle's, body axes.
  rov::Vec6 acceleration;

  static void fields(auto&& field, auto& self) {
    field("near_points", self.near_points);
    field("touched_steps", self.touched_steps);
    field("deepest_m", self.deepest_m);
    field("impulse_n_s", self.impulse_n_s);
    field("acceleration", self.acceleration);
  }
};

struct VehicleState {
  rov::State body;
  rov::Vec6 integral;  // the controller's
  std::array<double, rov::kMaxThrusters> command_n{};
  MissionState mission;
  ContactState contact;

  static void fields(auto&& field, auto& self) {
    field("body", self.body);
    field("integral", self.integral);
    field("command_n", self.command_n);
    field("mission", self.mission);
    field("contact", self.contact);
  }
};

// A diver who swims by moving limbs.
struct HumanPhysics {
  diver::HumanState human;
  diver::SwimmerState swimmer;  // what moves the limbs where nobody wears a suit
  std::uint64_t arrived = 0;    // waypoints, all rounds together
  Vec3 leg_from_ned_m{0.0};     // where the way to the next one begins, or where it stays
  ContactState contact;
  // The tank that is breathed from where nobody wears a suit, and which one is reached for.
  std::uint64_t tank = 0;
  diver::GasSwitchState gas_switch;

  static void fields(auto&& field, auto& self) {
    field("human", self.human);
    field("swimmer", self.swimmer);
    field("arrived", self.arrived);
    field("leg_from_ned_m", self.leg_from_ned_m);
    field("contact", self.contact);
    field("tank", self.tank);
    field("gas_switch", self.gas_switch);
  }
};

struct PhysicsState {
  std::uint64_t step = 0;
  std::uint64_t vehicle_count = 0, human_count = 0;  // that the scene has
  std::array<VehicleState, kMaxVehicles> vehicles;
  std::array<HumanPhysics, kMaxHumans> humans;

  static void fields(auto&& field, auto& self) {
    field("step", self.step);
    field("vehicle_count", self.vehicle_count);
    field("human_count", self.human_count);
    field("vehicles", self.vehicles);
    field("humans", self.humans);
  }
  // Who is not there costs nothing.
  static void in_use(auto&& field, auto& self) {
    field("step", self.step);
    field("vehicle_count", self.vehicle_count);
    field("human_count", self.human_count);
    for (std::size_t i = 0; i < self.vehicle_count; ++i) field("vehicles", self.vehicles[i]);
    for (std::size_t i = 0; i < self.human_count; ++i) field("humans", self.humans[i]);
  }
};

// From outside, for one vehicle.
struct VehicleInputs {
  // While piloted, instead of the mission: a wrench, body axes, as far as the thrusters have room
  // for it; depth and heading are held where it leaves them alone.
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
  // Joints, breath, buttons and tank of a person; while none is worn, they are the swimmer's own,
  // the tank only where the diver's file has gas switches by plan. Currents are the scene's.
  diver::HumanInputs human;
  std::uint64_t worn = 0;  // 0 or 1

  static void fields(auto&& field, auto& self) {
    field("human", self.human);
    field("worn", self.worn);
  }
};

struct PhysicsInputs {
  std::array<VehicleInputs, kMaxVehicles> vehicles;
  std::array<HumanSteering, kMaxHumans> humans;

  static void fields(auto&& field, auto& self) {
    field("vehicles", self.vehicles);
    field("humans", self.humans);
  }
};

// New inputs of one vehicle, or of one diver; of none where its number is too high.
struct PhysicsMessage {
  std::uint64_t vehicle = 0;
  VehicleInputs inputs;
  std::uint64_t is_human = 0;  // 1: then the number is a diver's, and what follows counts
  HumanSteering steering;

  static void fields(auto&& field, auto& self) {
    field("vehicle", self.vehicle);
    field("inputs", self.inputs);
    field("is_human", self.is_human);
    field("steering", self.steering);
  }
};

using PhysicsSimulation = sim::Simulation<PhysicsState, PhysicsInputs, PhysicsMessage>;

}  // namespace neritic::testbed
