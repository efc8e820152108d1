// What changes while a scene's vehicles move, as plain bytes: the state of a simulation
// (engine/sim/simulation.hpp), what steers it from outside, and the messages that change that. NED
// and forward, starboard, down (rov/). Any thread.
#pragma once

#include <array>
#include <cstdint>

#include "engine/sim/simulation.hpp"
#include "rov/dynamics.hpp"

namespace neritic::tools {

// So that a state can be copied as bytes.
inline constexpr std::size_t kMaxVehicles = 4;

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

  static void fields(auto&& field, auto& self) {
    field("near_points", self.near_points);
    field("touched_steps", self.touched_steps);
    field("deepest_m", self.deepest_m);
    field("impulse_n_s", self.impulse_n_s);
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

struct PhysicsState {
  std::uint64_t step = 0;
  std::array<VehicleState, kMaxVehicles> vehicles;

  static void fields(auto&& field, auto& self) {
    field("step", self.step);
    field("vehicles", self.vehicles);
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

struct PhysicsInputs {
  std::array<VehicleInputs, kMaxVehicles> vehicles;

  static void fields(auto&& field, auto& self) { field("vehicles", self.vehicles); }
};

// New inputs of one vehicle; of none where its number is too high.
struct PhysicsMessage {
  std::uint64_t vehicle = 0;
  VehicleInputs inputs;

  static void fields(auto&& field, auto& self) {
    field("vehicle", self.vehicle);
    field("inputs", self.inputs);
  }
};

using PhysicsSimulation = sim::Simulation<PhysicsState, PhysicsInputs, PhysicsMessage>;

}  // namespace neritic::tools
