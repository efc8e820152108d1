// The physics of a scene: its vehicles and divers, what is in their way, the current, and the step
// that a simulation takes. Built once from a scene, which may change or go afterwards; then only
// read, so that any thread may step. The step is pure: the same bits for the same arguments.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/sim/current.hpp"
#include "engine/sim/workers.hpp"
#include "rov/navigation.hpp"
#include "rov/near_added_mass.hpp"
#include "testbed/simulation/body_step.hpp"
#include "testbed/simulation/diver_condition.hpp"
#include "testbed/simulation/followed_points.hpp"
#include "testbed/simulation/gaze_targets.hpp"
#include "testbed/simulation/human_world.hpp"
#include "testbed/simulation/mission.hpp"
#include "testbed/simulation/modems.hpp"
#include "testbed/simulation/pair_finder.hpp"
#include "testbed/simulation/saved_state.hpp"
#include "testbed/simulation/tethers.hpp"
#include "testbed/simulation/things.hpp"
#include "testbed/simulation/vehicle_kinds.hpp"

namespace neritic::testbed {

// How a vehicle that flies on what it measures navigates.
struct VehicleNavigation {
  rov::NavigationModel model;
  std::size_t place = 0;  // in PhysicsState::navigation()
};

// A vehicle of the scene, prepared.
struct PhysicsVehicle {
  std::string name;
  std::size_t object = 0;   // index into Scene::objects
  const VehicleKind& kind;  // of the world, shared with its like
  const rov::VehicleFile& file = kind.model.file;
  const rov::Vehicle& vehicle = kind.model.vehicle;
  std::uint64_t failed_thrusters = 0;  // at the start
  std::optional<MissionGuide> mission;
  Vec3 tether_anchor_ned_m{0.0};      // of the file's
  std::optional<std::size_t> tether;  // of PhysicsState::tethers(); none: the scene names none
  std::optional<scene::Wash> wash;
  double near_radius_m = 0.0;  // of the sphere whose added mass grows near bounds; 0: not named
  rov::State start;
  std::optional<std::size_t> readings;  // of PhysicsState::readings(); none: without sensors
  // Of PhysicsState::earlier(); none: no sensor is faster than the steps.
  std::size_t first_earlier = 0, earlier = 0;
  std::optional<std::size_t> battery;  // of PhysicsState::batteries(); none: thrust costs nothing
  // Index in PhysicsState::propellers(); none: no propeller of the model turns, or a clip moves it.
  std::optional<std::size_t> turning;
  std::optional<VehicleNavigation> navigation;  // none: flies on its true state
  rov::SensorWater water;                       // around its sensors
};

// An object of the scene that devices move.
struct PhysicsObject {
  std::string name;
  std::size_t object = 0;            // index into Scene::objects
  std::optional<std::size_t> limbs;  // place in PhysicsState::limbs(); none: without limbs
  DrawnJoints joints;                // of one with limbs: whose model is a diver's
};

// Memory that a step works in, kept from step to step so that none allocates. Its content means
// nothing between steps.
struct VehicleScratch {
  // The part of the step that is being taken; its start is the state in the step's result.
  StepPart part;
  rov::Inputs acting;
  rov::State free;      // after the part, as if the water were empty; changed by what it meets
  rov::Vec6 alone_ned;  // its velocity then, as if there were no other vehicle or diver
  bool parted = false;
  bool pulled = false;    // by what it holds, or its tether
  ContactReport contact;  // of the step so far
  // The vehicle with the added mass that it has where it is; none: as in open water.
  std::vector<rov::Vehicle> near;
};
struct HumanScratch {
  HumanStep moving;
  bool parted = false;
  double taken_moles = 0.0;  // of the donor's tank
};
struct StepScratch {
  std::vector<VehicleScratch> vehicles;
  std::vector<HumanScratch> humans;
  std::vector<ThingWater> thing_waters;
  TetherScratch tether;
  PairFinder finder;
  sim::PairMemory pair;
  std::vector<sim::ContactMemory> contacts;  // of each thread
  sim::Workers workers;
};
// One call of the step.
struct StepCall {
  const PhysicsState& before;
  const PhysicsInputs& inputs;
  const sim::StepTime& time;
  StepScratch& scratch;
  PhysicsState& after;
};

class PhysicsWorld {
 public:
  // Whether anything of the scene moves by physics.
  static bool needed(const scene::Scene& scene);
  // Precondition: needed(scene). Errors in one line: files that do not read, vehicles that start in
  // something solid.
  static Result<std::unique_ptr<const PhysicsWorld>> create(const scene::Scene& scene);

  const std::vector<PhysicsVehicle>& vehicles() const { return vehicles_; }
  const std::vector<PhysicsHuman>& humans() const { return humans_; }
  const std::vector<PhysicsObject>& objects() const { return objects_; }
  const Modems& modems() const { return modems_; }
  const Things& things() const { return things_; }
  const Tethers& tethers() const { return tethers_; }
  // For the history of motion; the step does not need them.
  const std::vector<FollowedPoint>& followed() const { return followed_; }
  const sim::StaticWorld& solid() const { return solid_; }
  // The object of a label of solid(), and whether it is of class seabed.
  std::string solid_name(std::uint32_t label) const;
  bool is_bed(std::uint32_t label) const;
  // The names of the scene's objects, in order: a reading's number n is that of place n - 1.
  std::vector<std::string> object_names() const;
  std::uint64_t seed() const { return seed_; }
  double step_s() const { return step_s_; }
  const StepMethod& method() const { return method_; }
  // Whether the state after so many steps is the first at or after an instant of vehicle's control.
  bool control_due(std::size_t vehicle, std::uint64_t step) const;

  PhysicsState start() const;
  const PhysicsInputs& start_inputs() const { return start_inputs_; }
  // The step. scratch: of this world, used by one thread at a time. after: of the layout of
  // start().
  void step(const PhysicsState& before, const PhysicsInputs& inputs, const sim::StepTime& time,
            StepScratch& scratch, PhysicsState& after) const;
  StepScratch scratch(unsigned threads) const;
  // The same with memory of its own, for single steps.
  PhysicsState step(const PhysicsState& before, const PhysicsInputs& inputs,
                    const sim::StepTime& time) const;
  // A sample that arrived before step. Pure.
  void apply(PhysicsInputs& inputs, const Sample& sample, std::uint64_t step) const;
  // The streams that enter and leave, and the live sources that the scene names.
  const StreamTable& streams() const { return streams_; }
  const SourceNames& sources() const { return sources_; }
  // The scene's current, without waves.
  Vec3 current_ned_m_s(const Vec3& position_ned_m, double time_s) const;
  // The water's velocity, with waves that move bodies, and its head; no accelerations.
  diver::WaterFlow water_ned(const Vec3& position_ned_m, double time_s) const;
  // How fast the thrusters of vehicles that name their wash drive the water at a place of the
  // world.
  double wash_m_s(const PhysicsState& state, const Vec3& place_m) const;
  // The thing that a diver looks at.
  GazeTargets::Seen looks_at(const PhysicsState& state, std::size_t human, double time_s) const;
  // The newest readings of a vehicle's sensors; null where it has none.
  const rov::SensorReadings* readings(const PhysicsState& state, std::size_t vehicle) const;
  // The readings of the newest step before those, the oldest first: of each part of the step in
  // which a sensor read. Empty where no sensor is faster than the steps.
  std::span<const EarlierReadings> earlier_readings(const PhysicsState& state,
                                                    std::size_t vehicle) const;
  // The battery of a vehicle; null where its file names none.
  const rov::BatteryState* battery(const PhysicsState& state, std::size_t vehicle) const;
  // The motion of a vehicle as its own sensors estimate it; null, or absent: the vehicle flies on
  // its true state.
  const rov::NavigationState* navigation(const PhysicsState& state, std::size_t vehicle) const;
  std::optional<rov::NavigationEstimate> estimate(const PhysicsState& state,
                                                  std::size_t vehicle) const;
  // The state that its control and its mission go by.
  rov::State known_state(const PhysicsState& state, std::size_t vehicle, double time_s) const;
  // Rays of sensors: the first solid thing along a ray.
  rov::RayQuery rays() const;
  // Everything around a vehicle's sensors.
  rov::SensorWorld sensor_world(std::size_t vehicle) const;

  // The step with memory and threads of its own, for a simulation or a replay; borrows the world.
  // threads share the vehicles and divers of a step, with the same bits; 0: one thread for a small
  // scene, up to all cores for a crowd.
  PhysicsSimulation::Step step_function(unsigned threads = 0) const;
  // The format of saved states of this world.
  StateFormat state_format() const;
  // With an inbox in which the scene's sources are open. Borrows the world.
  std::unique_ptr<PhysicsSimulation> simulation(sim::SimulationOptions options,
                                                unsigned threads = 0) const;

 private:
  explicit PhysicsWorld(const scene::Scene& scene);
  Status choose_step(const scene::Scene& scene);
  Status add_vehicle(const scene::Scene& scene, std::size_t object);
  Status add_human(const scene::Scene& scene, std::size_t object);
  void add_object(const scene::Scene& scene, std::size_t object);
  Status find_donors(const scene::Scene& scene);
  void choose_inputs(const scene::Scene& scene);
  Status check_start(const scene::Scene& scene, const std::string& name,
                     const sim::BodyShape& shape, const Pose& start) const;
  bool forces_came(const VehicleInputs& inputs, const VehicleState& state,
                   std::uint64_t step) const;
  bool steer(std::size_t index, const StepCall& call, double time_s) const;
  void sense(std::size_t index, const rov::Vec6& contact, double from_s, double to_s,
             PhysicsState& state) const;
  void keep_readings(std::size_t index, std::uint64_t read_before, PhysicsState& state) const;
  VehicleStep whole_step(const StepCall& call, std::size_t i) const;
  VehicleStep part_step(const StepCall& call, std::size_t i) const;
  void begin_vehicle(const StepCall& call, std::size_t i, unsigned thread) const;
  void begin_part(const StepCall& call, std::size_t i) const;
  void add_near_bounds(std::size_t i, const rov::State& state, double time_s,
                       VehicleScratch& own) const;
  void end_part(const StepCall& call, std::size_t i, unsigned thread) const;
  void begin_human(const StepCall& call, std::size_t k) const;
  void part_all(const StepCall& call) const;
  bool part(const StepCall& call, std::size_t a, std::size_t b) const;
  void finish_vehicle(const StepCall& call, std::size_t i, unsigned thread) const;
  void finish_human(const StepCall& call, std::size_t k, unsigned thread) const;
  void step_modems(const StepCall& call) const;
  void pull_all(const StepCall& call) const;
  void step_tethers(const StepCall& call) const;
  void start_navigation(std::size_t index, PhysicsState& state) const;
  void navigate(std::size_t index, double time_s, PhysicsState& state) const;
  rov::Inputs acting_on(const PhysicsVehicle& vehicle, const VehicleInputs& inputs,
                        const VehicleState& state, double time_s, double dt_s) const;

  const Movers movers_;
  double step_s_ = 1.0 / 240.0;
  std::uint64_t seed_ = 0, scene_hash_ = 0;
  StepMethod method_;
  std::optional<sim::Current> current_;
  std::optional<SeaWaves> waves_;  // that move bodies
  sim::StaticWorld solid_;
  struct SolidObject {
    std::uint32_t first = 0, count = 0;  // its labels
    std::string name;
    bool bed = false;
  };
  std::vector<SolidObject> solid_objects_;
  const SolidObject* solid_object(std::uint32_t label) const;
  VehicleKinds kinds_;
  std::vector<PhysicsVehicle> vehicles_;
  std::vector<PhysicsHuman> humans_;
  std::vector<PhysicsObject> objects_;
  std::size_t sensing_ = 0;                      // vehicles with sensors
  std::size_t navigating_ = 0;                   // those that fly on what they measure
  std::size_t conditions_ = 0, regulators_ = 0;  // divers whose scene names them
  std::size_t limbs_ = 0;                        // objects with limbs
  std::size_t batteries_ = 0;                    // vehicles whose file names one
  std::size_t earlier_ = 0;                      // EarlierReadings of all vehicles
  std::size_t turning_ = 0;                      // vehicles whose propellers turn
  StreamTable streams_;
  SourceNames sources_;
  PhysicsInputs start_inputs_;
  Modems modems_;
  std::vector<FollowedPoint> followed_;
  GazeTargets gaze_targets_;
  Things things_;
  Tethers tethers_;
  double water_kg_m3_ = 1028.0;
  std::optional<LayeredWater>
      layers_;           // density, weight and sound, where the scene names its water
  bool washes_ = false;  // a vehicle names its wash
};

// How a vehicle with these sensors navigates, as the scene chooses; none: by its true state. An
// Error where sensors are missing.
Result<std::optional<rov::NavigationModel>> choose_navigation(const scene::Scene& scene,
                                                              const scene::Object& object,
                                                              const rov::SensorSet& sensors);

// The scene's current, with its grid read.
Result<sim::Current> current_of(const scene::Current& current);

}  // namespace neritic::testbed
