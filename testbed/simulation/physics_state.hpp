// All that changes while a scene's vehicles and divers move: the state of a simulation
// (engine/sim/simulation.hpp), one block of plain structs. NED and forward, starboard, down (rov/).
// Any thread.
#pragma once

#include <array>
#include <cstdint>

#include "diver/condition.hpp"
#include "diver/gas_switch.hpp"
#include "diver/human_step.hpp"
#include "diver/reach.hpp"
#include "diver/swimmer.hpp"
#include "engine/sim/block.hpp"
#include "engine/sim/simulation.hpp"
#include "rov/cable.hpp"
#include "rov/dynamics.hpp"
#include "rov/navigation_state.hpp"
#include "rov/sensor_set.hpp"
#include "sonar/modem.hpp"
#include "testbed/samples/inbox.hpp"
#include "testbed/simulation/joint_ease.hpp"
#include "testbed/simulation/physics_inputs.hpp"

namespace neritic::testbed {

// The progress of a mission.
struct MissionState {
  std::uint64_t arrived = 0, left = 0;  // waypoints, all rounds together
  double arrived_s = 0.0;               // at the waypoint where it holds
  Vec3 leg_from_ned_m{0.0};             // where the way to the next waypoint begins
  // The pilot of the last control period: 0 the mission, 1 a pilot, 2 a setpoint from outside, 3 a
  // velocity from outside, 4 forces of thrusters from outside.
  std::uint64_t piloted = 0;
  double speed_n = 0.0;  // of the observer (rov::ControlState); 0: nothing is learnt
  Vec3 lean_ned_m{0.0};  // of the controller's place against a steady push (rov::lean)
  // The controller's set value.
  Vec3 wanted_ned_m{0.0};
  Quat wanted_attitude{1.0, 0.0, 0.0, 0.0};

  static void fields(auto&& field, auto& self) {
    field("arrived", self.arrived);
    field("left", self.left);
    field("arrived_s", self.arrived_s);
    field("leg_from_ned_m", self.leg_from_ned_m);
    field("piloted", self.piloted);
    field("speed_n", self.speed_n);
    field("lean_ned_m", self.lean_ned_m);
    field("wanted_ned_m", self.wanted_ned_m);
    field("wanted_attitude", self.wanted_attitude);
  }
};

struct ContactState {
  std::uint64_t near_points = 0;    // in the last step
  std::uint64_t touched_steps = 0;  // so far
  double deepest_m = 0.0;           // so far
  Vec3 impulse_n_s{0.0};            // of the last step, world axes
  // Rate of the velocity by contacts alone, mean of the last step, body axes; vehicles only.
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
  std::array<GroupState, kVehicleGroups> groups;  // of its inputs

  static void fields(auto&& field, auto& self) {
    fields_but_groups(field, self);
    field("groups", self.groups);
  }
  static void fields_but_groups(auto&& field, auto& self) {
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
  diver::SwimmerState swimmer;  // moves the limbs under the autopilot
  std::uint64_t arrived = 0;    // waypoints, all rounds together
  Vec3 leg_from_ned_m{0.0};     // where the way to the next one begins, or the place to stay at
  ContactState contact;
  // The tank breathed from by plan, and the switch to another one.
  std::uint64_t tank = 0;
  diver::GasSwitchState gas_switch;
  std::array<GroupState, kDiverGroups> groups;  // of the inputs
  JointEase ease;                               // after a change of who moves the limbs
  diver::BendSides sides;                       // of what is tracked

  static void fields(auto&& field, auto& self) {
    fields_but_groups(field, self);
    field("groups", self.groups);
    field("ease", self.ease);
    field("sides", self.sides);
  }
  static void fields_but_groups(auto&& field, auto& self) {
    field("human", self.human);
    field("swimmer", self.swimmer);
    field("arrived", self.arrived);
    field("leg_from_ned_m", self.leg_from_ned_m);
    field("contact", self.contact);
    field("tank", self.tank);
    field("gas_switch", self.gas_switch);
  }
};

// An object that devices move.
struct ObjectState {
  Motion motion;                                 // world_from_object, where samples put it
  std::uint64_t placed = 0;                      // 0: it is where its own track or place has it
  std::array<GroupState, kObjectGroups> groups;  // of its inputs

  static void fields(auto&& field, auto& self) {
    fields_but_groups(field, self);
    field("groups", self.groups);
  }
  static void fields_but_groups(auto&& field, auto& self) {
    field("motion", self.motion);
    field("placed", self.placed);
  }
};

// The limbs of a diver who swims elsewhere, as samples of the joints move them.
struct LimbState {
  diver::JointRotations joints = diver::straight_joints();
  std::uint64_t shown = 0;  // 0: the model's clip moves them

  static void fields(auto&& field, auto& self) {
    field("joints", self.joints);
    field("shown", self.shown);
  }
};

// The tasks of a modem beside its messages: answers that it owes, and its own ranging.
struct ModemTasks {
  struct Answer {
    std::uint64_t owed = 0;  // 1: it is still to be sent
    std::uint64_t to = 0, number = 0;
    double at_s = 0.0;

    static void fields(auto&& field, auto& self) {
      field("owed", self.owed);
      field("to", self.to);
      field("number", self.number);
      field("at_s", self.at_s);
    }
  };
  struct Request {
    std::uint64_t waits = 0;  // 1: for its answer
    std::uint64_t number = 0;
    double asked_s = 0.0;

    static void fields(auto&& field, auto& self) {
      field("waits", self.waits);
      field("number", self.number);
      field("asked_s", self.asked_s);
    }
  };
  static constexpr std::size_t kOwed = 4, kAsked = 16;

  std::uint64_t sent = 0;    // of ModemInputs::asked
  std::uint64_t looked = 0;  // at reports of its ModemState
  std::array<Answer, kOwed> answers{};
  std::uint64_t unanswered = 0;  // requests that came while it owed kOwed answers
  // The rest: of one that ranges.
  std::uint64_t asks = 0;  // intervals of which the request is made or past
  std::array<Request, kAsked> requests{};
  std::uint64_t fixes = 0, misses = 0;  // as many as fix.count; misses: without an answer in time
  rov::Reading<rov::UsblReading> fix;

  static void fields(auto&& field, auto& self) {
    field("sent", self.sent);
    field("looked", self.looked);
    field("answers", self.answers);
    field("unanswered", self.unanswered);
    field("asks", self.asks);
    field("requests", self.requests);
    field("fixes", self.fixes);
    field("misses", self.misses);
    field("fix", self.fix);
  }
};

// The regulators of a diver whose scene names them.
struct RegulatorState {
  std::uint64_t donor = 0;  // number of the diver whose gas is breathed, from 1 on; 0: its own
  double wanted_s = 0.0;    // since it is wanted and in reach
  double taken_moles = 0.0, blown_moles = 0.0;  // so far
  double flow_moles_s = 0.0;                    // of a free flow, in the last step
  std::uint64_t torn = 0;                       // how often the hose was too short

  static void fields(auto&& field, auto& self) {
    field("donor", self.donor);
    field("wanted_s", self.wanted_s);
    field("taken_moles", self.taken_moles);
    field("blown_moles", self.blown_moles);
    field("flow_moles_s", self.flow_moles_s);
    field("torn", self.torn);
  }
};

// A thing that is carried (things.hpp). Where it is: its ObjectState.
struct ThingState {
  std::uint64_t holder = 0;  // number of the grip that holds it, from 1 on; 0: it is free
  std::uint64_t rests = 0;   // 1: in its rack, not yet grabbed
  std::uint64_t handovers = 0;
  Quat grip_from_thing{1.0, 0.0, 0.0, 0.0};

  static void fields(auto&& field, auto& self) {
    field("holder", self.holder);
    field("rests", self.rests);
    field("handovers", self.handovers);
    field("grip_from_thing", self.grip_from_thing);
  }
};
struct GripState {
  std::uint64_t held = 0;  // number of the object that it holds, from 1 on; 0: none
  double load_n = 0.0;     // of late (things.cpp)
  std::uint64_t grabs = 0, drops = 0;

  static void fields(auto&& field, auto& self) {
    field("held", self.held);
    field("load_n", self.load_n);
    field("grabs", self.grabs);
    field("drops", self.drops);
  }
};

// A vehicle's tether (tethers.hpp); its nodes are apart.
struct TetherState {
  double length_m = 0.0;  // paid out
  Vec3 top_ned_m{0.0}, end_ned_m{0.0};
  Vec3 pull_ned_n{0.0};  // on the vehicle, in the last step
  double end_n = 0.0, top_n = 0.0, most_n = 0.0;
  std::uint64_t touching = 0;     // segments
  std::uint64_t unconverged = 0;  // steps so far

  static void fields(auto&& field, auto& self) {
    field("length_m", self.length_m);
    field("top_ned_m", self.top_ned_m);
    field("end_ned_m", self.end_ned_m);
    field("pull_ned_n", self.pull_ned_n);
    field("end_n", self.end_n);
    field("top_n", self.top_n);
    field("most_n", self.most_n);
    field("touching", self.touching);
    field("unconverged", self.unconverged);
  }
};

// The turns of a vehicle's propellers (propellers.hpp), by thruster, forward positive. Not wrapped,
// so that two states tell how far they turned between: in a year at 60 a second they are still
// exact to 1e-6.
struct PropellerState {
  std::array<double, rov::kMaxThrusters> revolutions{};

  static void fields(auto&& field, auto& self) { field("revolutions", self.revolutions); }
};

// The readings of a vehicle's sensors at the end of a part of the newest step, but its last: with
// sensors faster than the steps, all of their readings stay here until the next step.
struct EarlierReadings {
  std::uint64_t kept = 0;  // 1: of the newest step; 0: free
  rov::SensorReadings readings;

  static void fields(auto&& field, auto& self) {
    field("kept", self.kept);
    field("readings", self.readings);
  }
};

// The state of a scene's physics: one block, sized once from the scene (PhysicsWorld::start()).
class PhysicsState
    : public sim::Block<VehicleState, HumanPhysics, rov::SensorReadings, rov::NavigationState,
                        ObjectState, sonar::ModemState, ModemTasks, diver::ConditionState,
                        RegulatorState, ThingState, GripState, LimbState, TetherState,
                        rov::CableNode, rov::BatteryState, EarlierReadings, PropellerState> {
 public:
  PhysicsState() = default;
  // sensing: vehicles that have sensors; navigating: those that fly on what they measure; objects:
  // those that devices move; conditions, regulators: divers whose scene names them; limbs: objects
  // with limbs; batteries: vehicles whose file names one; earlier: of all vehicles; propellers:
  // vehicles whose model has some that turn.
  PhysicsState(std::size_t vehicles, std::size_t humans, std::size_t sensing,
               std::size_t navigating, std::size_t objects = 0, std::size_t modems = 0,
               std::size_t conditions = 0, std::size_t regulators = 0, std::size_t things = 0,
               std::size_t grips = 0, std::size_t limbs = 0, std::size_t tethers = 0,
               std::size_t tether_nodes = 0, std::size_t batteries = 0, std::size_t earlier = 0,
               std::size_t propellers = 0)
      : Block({vehicles, humans, sensing, navigating, objects, modems, modems, conditions,
               regulators, things, grips, limbs, tethers, tether_nodes, batteries, earlier,
               propellers}) {}
  // One of each kind.
  static PhysicsState example() {
    return PhysicsState(1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1);
  }

  std::span<VehicleState> vehicles() { return part<VehicleState>(); }
  std::span<const VehicleState> vehicles() const { return part<VehicleState>(); }
  std::span<HumanPhysics> humans() { return part<HumanPhysics>(); }
  std::span<const HumanPhysics> humans() const { return part<HumanPhysics>(); }
  // For the vehicles that have sensors, in their order: PhysicsWorld::readings() finds a vehicle's.
  std::span<rov::SensorReadings> readings() { return part<rov::SensorReadings>(); }
  std::span<const rov::SensorReadings> readings() const { return part<rov::SensorReadings>(); }
  // For the vehicles that fly by their own sensors: PhysicsWorld::navigation() finds a vehicle's.
  std::span<rov::NavigationState> navigation() { return part<rov::NavigationState>(); }
  std::span<const rov::NavigationState> navigation() const { return part<rov::NavigationState>(); }
  std::span<ObjectState> objects() { return part<ObjectState>(); }
  std::span<const ObjectState> objects() const { return part<ObjectState>(); }
  std::span<sonar::ModemState> modems() { return part<sonar::ModemState>(); }
  std::span<const sonar::ModemState> modems() const { return part<sonar::ModemState>(); }
  std::span<ModemTasks> modem_tasks() { return part<ModemTasks>(); }
  std::span<const ModemTasks> modem_tasks() const { return part<ModemTasks>(); }
  // For the objects that have limbs, in their order.
  std::span<LimbState> limbs() { return part<LimbState>(); }
  std::span<const LimbState> limbs() const { return part<LimbState>(); }

  // For the vehicles with a tether: PhysicsVehicle::tether finds a vehicle's. Their nodes, from the
  // top down, one tether after another.
  std::span<TetherState> tethers() { return part<TetherState>(); }
  std::span<const TetherState> tethers() const { return part<TetherState>(); }
  std::span<rov::CableNode> tether_nodes() { return part<rov::CableNode>(); }
  std::span<const rov::CableNode> tether_nodes() const { return part<rov::CableNode>(); }
  // For the vehicles that have one: PhysicsWorld::battery() finds a vehicle's.
  std::span<rov::BatteryState> batteries() { return part<rov::BatteryState>(); }
  std::span<const rov::BatteryState> batteries() const { return part<rov::BatteryState>(); }
  // One vehicle's after another's: PhysicsWorld::earlier_readings() finds a vehicle's.
  std::span<EarlierReadings> earlier() { return part<EarlierReadings>(); }
  std::span<const EarlierReadings> earlier() const { return part<EarlierReadings>(); }
  // For the vehicles whose model has some: PhysicsVehicle::turning finds a vehicle's.
  std::span<PropellerState> propellers() { return part<PropellerState>(); }
  std::span<const PropellerState> propellers() const { return part<PropellerState>(); }
  // For the divers whose condition the scene names: PhysicsHuman::condition finds a diver's.
  std::span<diver::ConditionState> conditions() { return part<diver::ConditionState>(); }
  std::span<const diver::ConditionState> conditions() const {
    return part<diver::ConditionState>();
  }
  std::span<ThingState> things() { return part<ThingState>(); }
  std::span<const ThingState> things() const { return part<ThingState>(); }
  std::span<GripState> grips() { return part<GripState>(); }
  std::span<const GripState> grips() const { return part<GripState>(); }
  std::span<RegulatorState> regulators() { return part<RegulatorState>(); }
  std::span<const RegulatorState> regulators() const { return part<RegulatorState>(); }

  static void fields(auto&& field, auto& self) {
    auto vehicles = self.vehicles();
    auto humans = self.humans();
    auto readings = self.readings();
    auto navigation = self.navigation();
    auto objects = self.objects();
    auto modems = self.modems();
    auto modem_tasks = self.modem_tasks();
    auto limbs = self.limbs();
    field("vehicles", vehicles);
    field("humans", humans);
    field("readings", readings);
    field("navigation", navigation);
    field("objects", objects);
    field("modems", modems);
    field("modem_tasks", modem_tasks);
    auto conditions = self.conditions();
    auto regulators = self.regulators();
    field("conditions", conditions);
    field("regulators", regulators);
    auto things = self.things();
    auto grips = self.grips();
    field("things", things);
    field("grips", grips);
    field("limbs", limbs);
    auto tethers = self.tethers();
    auto tether_nodes = self.tether_nodes();
    field("tethers", tethers);
    field("tether_nodes", tether_nodes);
    auto batteries = self.batteries();
    field("batteries", batteries);
    auto earlier = self.earlier();
    field("earlier", earlier);
    auto propellers = self.propellers();
    field("propellers", propellers);
  }
  // The hash covers groups once a live source was asked for, but no numbers of sources, the joints
  // of divers while they are eased, and of the kinds after the first three those that the scene
  // has, without the last: nothing of the physics reads how far propellers turned.
  std::span<const std::uint64_t> hashed_counts() const {
    std::size_t kinds = kKinds - 1;
    while (kinds > 3 && counts()[kinds - 1] == 0) --kinds;
    return std::span(counts()).first(kinds);
  }
  static void hashed_fields(auto&& field, auto& self) {
    const auto add = [&](auto& one) {
      std::remove_cvref_t<decltype(one)>::fields_but_groups(field, one);
      for (const GroupState& group : one.groups)
        if (group.phase != GroupPhase::kChosen || group.losses > 0) {
          for (auto& each : one.groups) GroupState::fields_but_sources(field, each);
          return;
        }
    };
    for (auto& vehicle : self.vehicles()) add(vehicle);
    for (auto& human : self.humans()) {
      add(human);
      if (human.ease.left_s > 0.0) field("ease", human.ease);
    }
    for (auto& object : self.objects()) add(object);
    auto readings = self.readings();
    auto navigation = self.navigation();
    field("readings", readings);
    if (!navigation.empty()) field("navigation", navigation);
    auto limbs = self.limbs();
    if (!limbs.empty()) field("limbs", limbs);
    auto batteries = self.batteries();
    if (!batteries.empty()) field("batteries", batteries);
    auto earlier = self.earlier();
    if (!earlier.empty()) field("earlier", earlier);
    auto modems = self.modems();
    auto modem_tasks = self.modem_tasks();
    if (!modems.empty()) field("modems", modems), field("modem_tasks", modem_tasks);
    auto conditions = self.conditions();
    auto regulators = self.regulators();
    if (!conditions.empty()) field("conditions", conditions);
    if (!regulators.empty()) field("regulators", regulators);
    auto things = self.things();
    auto grips = self.grips();
    if (!things.empty()) field("things", things), field("grips", grips);
    auto tethers = self.tethers();
    auto tether_nodes = self.tether_nodes();
    if (!tethers.empty()) field("tethers", tethers), field("tether_nodes", tether_nodes);
  }
};

using PhysicsSimulation = sim::Simulation<PhysicsState, PhysicsInputs, SampleInbox>;

}  // namespace neritic::testbed

// Compiled once, with the optimisation of this library: programs that use them in code of less
// optimisation would else step, hash and check with that code's copy.
namespace neritic::sim {

extern template void add_state(Hash64& hash, const testbed::PhysicsState& state);
extern template std::uint64_t state_hash(const testbed::PhysicsState& state);
extern template std::uint64_t state_hash(std::uint64_t step, const testbed::PhysicsState& state);
extern template bool all_finite(const testbed::PhysicsState& state);
extern template void check_fields_cover(const testbed::PhysicsState& state);
extern template class SnapshotSource<testbed::PhysicsState>;
extern template class SnapshotReader<testbed::PhysicsState>;
extern template class Simulation<testbed::PhysicsState, testbed::PhysicsInputs,
                                 testbed::SampleInbox>;

}  // namespace neritic::sim
