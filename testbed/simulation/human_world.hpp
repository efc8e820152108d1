// The divers of a scene who swim by moving limbs: read and checked once, then only read; and their
// step through the water and along what is solid, a pure function. World of the diver north, east,
// down; body forward (to the head), starboard, down.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diver/button_recording.hpp"
#include "diver/diver_file.hpp"
#include "diver/limb_recording.hpp"
#include "engine/scene/node_motion.hpp"
#include "engine/scene/scene.hpp"
#include "engine/sim/body_shape.hpp"
#include "engine/sim/static_world.hpp"
#include "testbed/simulation/body_step.hpp"
#include "testbed/simulation/physics_state.hpp"

namespace neritic::testbed {

// The joints of a drawn diver: nodes of the model, one a segment, and how far its arms are spread.
struct DrawnJoints {
  std::vector<int> nodes;
  double arms_spread_rad = 0.0;
};
// The first segment whose node the model lacks is `missing`; empty: it is a diver's model.
DrawnJoints drawn_joints_of(const scene::Model& model, std::string_view& missing);

// A diver's condition, or regulators, that the scene names (diver_condition.hpp).
struct PhysicsCondition {
  diver::ConditionSettings settings;
  bool acts = true;
  bool own_water = false;  // its temperature is named, rather than that of the water's layers
  std::size_t place = 0;   // in PhysicsState::conditions()
};
struct PhysicsRegulator {
  std::optional<std::size_t> donor;  // a diver
  std::size_t donor_tank = 0;
  double hose_m = 1.0, reaction_s = 5.0;
  std::vector<scene::FreeFlow> free_flows;
  std::size_t place = 0;  // in PhysicsState::regulators()
};
// The abilities that the condition leaves a diver.
struct Ability {
  bool conscious = true, holds_breath = false;
  double slowing = 1.0, strength = 1.0;
  double shiver_w = 0.0, slack = 0.0;  // slack: ConditionState
  std::optional<Vec3> hand_to_m;       // where the right one reaches, in the world
};

// A node of a diver's gear.
struct DrawnGear {
  Vec3 scale{1.0};      // 0 removes what this diver does not wear
  bool swells = false;  // with the gas in the jacket
};

// A diver of the scene, prepared.
struct PhysicsHuman {
  std::string name;
  std::size_t object = 0;  // index into Scene::objects
  diver::DiverFile file;
  diver::Body body;
  std::unique_ptr<const diver::DiveComputer> computer;
  // Where to swim; no points: hovers.
  std::vector<Vec3> waypoints_ned_m;
  double speed_m_s = 0.0, acceptance_m = 1.0;
  scene::SpeedOver speed_over = scene::SpeedOver::kWater;
  bool repeat = false;
  std::optional<diver::LimbRecording> recording;  // moves the limbs instead
  // Presses the jacket's buttons from its first row on, in place of the swimmer.
  std::optional<diver::ButtonRecording> buttons;
  sim::BodyShape shape;  // for contacts: model axes (starboard, up, back) of who swims
  // The joints of the drawn model: its nodes, one a segment, then those of gear; how far its arms
  // are spread; the diver's size over the model's; and each node of gear.
  std::vector<int> nodes;
  double arms_spread_rad = 0.0, scale = 1.0;
  std::vector<DrawnGear> gear;
  std::optional<PhysicsCondition> condition;
  std::optional<PhysicsRegulator> regulator;
  HumanPhysics start;
};

// Errors in one line: files that do not read, models without the segments' nodes.
Result<PhysicsHuman> physics_human(const scene::Scene& scene, std::size_t object);

// The speed through the water at which a diver makes that speed over ground along way_ned in that
// current, swimming aslant against a current from the side.
double through_water_m_s(double over_ground_m_s, const Vec3& way_ned, const Vec3& current_ned_m_s);
// The diver's present goal. One who swims by the speed over ground feels the current.
diver::SwimGoal swim_goal(const PhysicsHuman& human, const HumanPhysics& state);

// A diver's motion in a step, for contacts; world axes.
struct HumanStep {
  sim::InverseMass inverse_mass{};
  Pose before;
  sim::BodyMotion free;  // as if alone; what it meets changes it
};
// The inputs of each group's authority in this step; steps the groups and the swimmer. Without
// currents.
diver::HumanInputs acting_inputs(const PhysicsHuman& human, const DiverInputs& inputs,
                                 std::uint64_t step, double dt_s, const Ability& able,
                                 HumanPhysics& state);
// The diver dt_s later, without contacts. borrowed: breathed from in place of the own tanks.
HumanStep free_human(const PhysicsHuman& human, const DiverInputs& inputs,
                     const diver::WaterFlow& water, std::uint64_t step, double dt_s,
                     const Ability& able, diver::BorrowedTank* borrowed, HumanPhysics& state);
// The diver as the solver of pairs takes it.
sim::PairBody pair_body(const PhysicsHuman& human, const HumanStep& moving);
// Whether a diver touched a vehicle, or another diver: the free steps of both then part, by equal
// and opposite impulses.
bool part_from_vehicle(const PhysicsHuman& human, HumanStep& moving, const VehicleStep& vehicle,
                       rov::State& free, sim::PairMemory& memory);
bool part_humans(const PhysicsHuman& a, HumanStep& moving_a, const PhysicsHuman& b,
                 HumanStep& moving_b, double dt_s, sim::PairMemory& memory);
// Moves along solid things, and samples the dive computer. parted: a moving body was touched.
// head_m: of waves, at the step's end (diver::WaterFlow).
void end_human(const PhysicsHuman& human, const sim::StaticWorld& solid, const HumanStep& moving,
               bool parted, double head_m, std::uint64_t step, double dt_s, const Ability& able,
               sim::ContactMemory& memory, HumanPhysics& state);

// The drawn diver: the pose of the model, and its nodes' rotations and scales (breath).
Pose drawn_pose(const HumanPhysics& state);
scene::NodeKey drawn_joints(const PhysicsHuman& human, const HumanPhysics& state, double time_s);
// The same of one who swims elsewhere; without rotations while the model's clip moves it.
scene::NodeKey drawn_joints(const DrawnJoints& drawn, const LimbState& state, double time_s);

}  // namespace neritic::testbed
