// Reads and checks once: the vehicles, what is solid, the current (physics_world.hpp); and makes a
// simulation of them.
#include "testbed/simulation/physics_world.hpp"

#include <algorithm>
#include <cmath>

#include "diver/reach.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "rov/frames.hpp"
#include "rov/navigation_water.hpp"
#include "rov/step_choice.hpp"
#include "testbed/simulation/place_outlook.hpp"
#include "testbed/simulation/scene_hash.hpp"
#include "testbed/simulation/static_scene.hpp"

namespace neritic::testbed {
namespace {

// A vehicle that starts deeper than this in something solid is a mistake of the scene's.
constexpr double kMostStartDepth_m = 0.02;

Status check_anchor(const scene::Scene& scene, const scene::Object& object, bool tethered) {
  if (tethered && object.dynamics->tether)
    return bad_input("{}: {}: tether found; accepted: no such key, since {} has a [tether]",
                     scene.path, object.name, object.dynamics->file.string());
  if (tethered == object.dynamics->tether_anchor_m.has_value()) return {};
  if (tethered)
    return bad_input(
        "{}: {}: tether_anchor_m: nothing found; accepted: [x, y, z], since {} has a "
        "tether",
        scene.path, object.name, object.dynamics->file.string());
  return bad_input("{}: {}: tether_anchor_m found; accepted: no such key, since {} has no tether",
                   scene.path, object.name, object.dynamics->file.string());
}

}  // namespace

Result<sim::Current> current_of(const scene::Current& current) {
  sim::Current out;
  switch (current.kind) {
    case scene::Current::Kind::kUniform:
      out = sim::UniformCurrent{current.velocity_m_s};
      break;
    case scene::Current::Kind::kPowerLaw:
      out = sim::PowerLawCurrent{current.velocity_m_s, current.depth_m, current.exponent};
      break;
    case scene::Current::Kind::kLinear:
      out = sim::LinearCurrent{current.velocity_m_s, current.deep_velocity_m_s, current.depth_m};
      break;
    case scene::Current::Kind::kGrid: {
      NERITIC_TRY(out, sim::read_grid_current(current.file, {current.origin_m, current.spacing_m,
                                                             current.start_s, current.interval_s}));
      break;
    }
  }
  if (const Status checked = sim::check_current(out); !checked.ok())
    return bad_input("current: {}", checked.error().message);
  return out;
}

bool PhysicsWorld::needed(const scene::Scene& scene) {
  for (const scene::Object& object : scene.objects)
    if (object.dynamics || object.human || object.thing || !object.inputs.empty()) return true;
  return false;
}

PhysicsWorld::PhysicsWorld(const scene::Scene& scene) : movers_(scene) {}

Result<std::unique_ptr<const PhysicsWorld>> PhysicsWorld::create(const scene::Scene& scene) {
  if (!scene.physics)
    return refusal(scene.path, "no physics", "a scene in which something moves by physics");
  std::unique_ptr<PhysicsWorld> world(new PhysicsWorld(scene));
  world->seed_ = scene.seed;
  if (scene.current) {
    NERITIC_TRY(world->current_, current_of(*scene.current));
  }
  if (scene.water && scene.water->waves && scene.water->waves_move)
    world->waves_.emplace(*scene.water->waves);
  NERITIC_TRY(world->solid_, static_world_of(scene));
  for (const scene::Object& object : scene.objects) {
    const auto found = scene.class_names.find(object.class_id);
    world->solid_objects_.push_back(
        {object.instance, static_cast<std::uint32_t>(object.instance_count()), object.name,
         found != scene.class_names.end() && found->second == "seabed"});
  }
  NERITIC_TRY_STATUS(world->choose_step(scene));
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].dynamics) NERITIC_TRY_STATUS(world->add_vehicle(scene, i));
    if (scene.objects[i].human) NERITIC_TRY_STATUS(world->add_human(scene, i));
    if (!scene.objects[i].inputs.empty() || scene.objects[i].thing) world->add_object(scene, i);
  }
  NERITIC_TRY_STATUS(world->find_donors(scene));
  NERITIC_TRY(world->things_, Things::create(scene, world->movers_));
  NERITIC_TRY(world->tethers_, Tethers::create(scene, world->movers_));
  for (std::size_t i = 0; i < world->tethers_.all().size(); ++i)
    world->vehicles_[world->tethers_.all()[i].vehicle].tether = i;
  world->water_kg_m3_ = scene.physics->water_kg_m3;
  if (scene.water && scene.water->column) world->layers_.emplace(*scene.water->column);
  for (PhysicsVehicle& vehicle : world->vehicles_) {
    if (world->layers_) vehicle.water.layers = &*world->layers_;
    if (vehicle.navigation)
      rov::allow_for_water(vehicle.water, deepest_m(vehicle), vehicle.navigation->model);
  }
  NERITIC_TRY(world->modems_, Modems::create(scene, world->movers_));
  world->followed_ = followed_points(scene, world->movers_);
  if (!world->humans_.empty()) world->gaze_targets_ = GazeTargets(scene, world->movers_);
  for (const PhysicsModem& modem : world->modems_.all())
    if (modem.sort == OwnerSort::kVehicle && modem.ranging &&
        world->vehicles_[modem.owner].file.sensors.usbl)
      return bad_input("{}: {}: modem.usbl beside a file with [usbl]; accepted: one of them",
                       scene.path, modem.name);
  std::vector<std::uint64_t> vehicle_files;
  for (const PhysicsVehicle& vehicle : world->vehicles_)
    vehicle_files.push_back(vehicle.kind.model.hash);
  NERITIC_TRY(world->scene_hash_, scene_hash(scene, vehicle_files));
  world->choose_inputs(scene);
  if (world->sources_.size() >= SampleInbox::kMaxSources)
    return bad_input("{}: inputs of {} live sources; accepted: up to {}", scene.path,
                     world->sources_.size(), SampleInbox::kMaxSources - 1);
  if (world->tethers_.any())
    if (const Status long_enough = world->tethers_.check_lengths(world->start()); !long_enough.ok())
      return bad_input("{}: {}", scene.path, long_enough.error().message);
  return std::unique_ptr<const PhysicsWorld>(std::move(world));
}

void PhysicsWorld::choose_inputs(const scene::Scene& scene) {
  start_inputs_ = PhysicsInputs(vehicles_.size(), humans_.size(), objects_.size(),
                                modems_.all().size(), regulators_, things_.grips().size(), limbs_);
  const auto modem = [&](OwnerSort sort, std::size_t owner) {
    return modems_.sort_of(sort, static_cast<std::uint32_t>(owner));
  };
  const auto grip_kinds = [&](OwnerSort sort, std::size_t owner) -> std::vector<PayloadKind> {
    if (!things_.find(sort, static_cast<std::uint32_t>(owner))) return {};
    return {PayloadKind::kGripper, PayloadKind::kGrip};
  };
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    std::vector<PayloadKind> named = grip_kinds(OwnerSort::kVehicle, i);
    if (vehicles_[i].tether) named.push_back(PayloadKind::kTether);
    if (vehicles_[i].battery) named.push_back(PayloadKind::kBattery);
    streams_.add_vehicle(vehicles_[i].name, vehicles_[i].file.sensors,
                         modem(OwnerSort::kVehicle, i), named);
    start_inputs_.vehicles()[i] =
        chosen_inputs(scene.objects[vehicles_[i].object].dynamics->inputs, sources_);
  }
  for (std::size_t i = 0; i < humans_.size(); ++i) {
    const PhysicsHuman& human = humans_[i];
    std::vector<PayloadKind> named = grip_kinds(OwnerSort::kDiver, i);
    if (human.condition) named.push_back(PayloadKind::kCondition);
    if (human.regulator) named.insert(named.end(), {PayloadKind::kSupply, PayloadKind::kRegulator});
    streams_.add_diver(human.name, modem(OwnerSort::kDiver, i), named);
    start_inputs_.humans()[i] =
        chosen_inputs(scene.objects[human.object].human->inputs, human.recording.has_value(),
                      human.buttons.has_value(), sources_);
  }
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    streams_.add_object(objects_[i].name, modem(OwnerSort::kObject, i),
                        objects_[i].limbs.has_value());
    start_inputs_.objects()[i] =
        chosen_object_inputs(scene.objects[objects_[i].object].inputs, sources_);
  }
}

Status PhysicsWorld::choose_step(const scene::Scene& scene) {
  const scene::Physics& physics = *scene.physics;
  if (physics.max_error_m == 0.0) {
    step_s_ = 1.0 / physics.rate_hz;
    NERITIC_TRY(method_.integrator, rov::integrator_of(physics.integrator));
    return {};
  }
  const sim::StaticWorldCounts& things = solid_.counts();
  const rov::Touchable touchable = things.things == 0    ? rov::Touchable::kNothing
                                   : things.creased == 0 ? rov::Touchable::kEven
                                                         : rov::Touchable::kUneven;
  const auto choice = rov::cheapest_step(physics.max_error_m, touchable);
  if (!choice.ok()) return bad_input("{}: physics.{}", scene.path, choice.error().message);
  step_s_ = 1.0 / choice->hz;
  method_ = {rov::Integrator::kGuarded, choice->contact_error_m};
  return {};
}

Status PhysicsWorld::add_vehicle(const scene::Scene& scene, std::size_t index) {
  const scene::Object& object = scene.objects[index];
  const scene::Dynamics& dynamics = *object.dynamics;
  NERITIC_TRY(const VehicleKind* kind, kinds_.of(scene, object, step_s_));
  NERITIC_TRY_STATUS(check_anchor(scene, object, kind->model.vehicle.tether.has_value()));
  PhysicsVehicle out{.name = object.name, .object = index, .kind = *kind};
  out.failed_thrusters = dynamics.failed_thrusters;
  if (dynamics.mission) out.mission.emplace(scene, *dynamics.mission, movers_);
  out.wash = dynamics.wash;
  if (dynamics.near_added_mass)
    out.near_radius_m = rov::displaced_radius_m(out.vehicle, water_kg_m3_);
  washes_ = washes_ || dynamics.wash;
  if (dynamics.tether_anchor_m)
    out.tether_anchor_ned_m = rov::ned_from_world(*dynamics.tether_anchor_m);
  const Pose at = scene.world_from(object.mount, 0.0);
  rov::teleport(out.start, rov::ned_from_world(at.position_m), rov::ned_from_world(at.rotation));
  NERITIC_TRY_STATUS(check_start(scene, out.name, kind->solid.shape,
                                 rov::world_pose(out.start.position_ned_m, out.start.attitude)));
  if (out.file.sensors.any()) out.readings = sensing_++;
  out.first_earlier = earlier_;
  out.earlier = earlier_in_step(out.file.sensors, step_s_);
  earlier_ += out.earlier;
  if (out.file.parameters.battery) out.battery = batteries_++;
  if (!kind->propellers.empty() && object.clip < 0) out.turning = turning_++;
  NERITIC_TRY(auto navigation, choose_navigation(scene, object, out.file.sensors));
  if (navigation) out.navigation = VehicleNavigation{std::move(*navigation), navigating_++};
  out.water = {scene.physics->water_kg_m3, out.file.gravity_m_s2,
               1e5 * diver::surface_bar_at(scene.physics->altitude_m)};
  vehicles_.push_back(std::move(out));
  return {};
}

Status PhysicsWorld::add_human(const scene::Scene& scene, std::size_t index) {
  NERITIC_TRY(PhysicsHuman human, physics_human(scene, index));
  const diver::RootState& root = human.start.human.root;
  NERITIC_TRY_STATUS(check_start(scene, human.name, human.shape,
                                 rov::world_pose(root.position_ned_m, root.attitude)));
  if (human.condition) {
    human.condition->place = conditions_++;
    // Drawn for each diver in turn, unless the scene says it.
    if (!scene.objects[index].human->condition->oxygen_tolerance)
      human.condition->settings.oxygen_tolerance = drawn_tolerance(seed_, humans_.size());
  }
  if (human.regulator) human.regulator->place = regulators_++;
  humans_.push_back(std::move(human));
  return {};
}

void PhysicsWorld::add_object(const scene::Scene& scene, std::size_t index) {
  const scene::Object& object = scene.objects[index];
  PhysicsObject out{.name = object.name, .object = index};
  if (!object.inputs.empty() && object.model >= 0 && object.copies.empty()) {
    std::string_view missing;
    out.joints = drawn_joints_of(*scene.models[static_cast<std::size_t>(object.model)], missing);
    if (missing.empty()) out.limbs = limbs_++;
  }
  objects_.push_back(std::move(out));
}

// The donors, once all divers are known.
Status PhysicsWorld::find_donors(const scene::Scene& scene) {
  for (PhysicsHuman& human : humans_) {
    if (!human.regulator) continue;
    const std::string& name = scene.objects[human.object].human->regulator->donor;
    if (name.empty()) continue;
    std::string names;
    for (std::size_t k = 0; k < humans_.size(); ++k) {
      if (&humans_[k] == &human) continue;
      names += (names.empty() ? "" : ", ") + humans_[k].name;
      if (humans_[k].name == name) human.regulator->donor = k;
    }
    if (!human.regulator->donor)
      return bad_input("{}: {}: regulator.donor: found '{}'; accepted: {}", scene.path, human.name,
                       printable(name), names.empty() ? "another diver: there is none" : names);
    const std::size_t tanks = humans_[*human.regulator->donor].body.tank_count;
    if (human.regulator->donor_tank >= tanks)
      return bad_input("{}: {}: regulator.donor_tank: found {}; accepted: below {}, {}'s tanks",
                       scene.path, human.name, human.regulator->donor_tank, tanks, name);
  }
  return {};
}

Status PhysicsWorld::check_start(const scene::Scene& scene, const std::string& name,
                                 const sim::BodyShape& shape, const Pose& start) const {
  sim::ContactMemory memory;
  for (const sim::Contact& contact : solid_.contacts(shape, start, 0.0, memory))
    if (contact.inside || contact.gap_m < -kMostStartDepth_m)
      return bad_input("{}: {}: starts {:.2f} m deep in {}; accepted: a place in the water",
                       scene.path, name, -contact.gap_m, solid_name(contact.surface.label));
  return {};
}

const PhysicsWorld::SolidObject* PhysicsWorld::solid_object(std::uint32_t label) const {
  const auto found = std::ranges::find_if(solid_objects_, [&](const SolidObject& object) {
    return label >= object.first && label < object.first + object.count;
  });
  return found == solid_objects_.end() ? nullptr : &*found;
}

std::string PhysicsWorld::solid_name(std::uint32_t label) const {
  const SolidObject* object = solid_object(label);
  return object ? object->name : "something";
}

bool PhysicsWorld::is_bed(std::uint32_t label) const {
  const SolidObject* object = solid_object(label);
  return object && object->bed;
}

const rov::SensorReadings* PhysicsWorld::readings(const PhysicsState& state,
                                                  std::size_t vehicle) const {
  const auto& at = vehicles_[vehicle].readings;
  return at ? &state.readings()[*at] : nullptr;
}

std::span<const EarlierReadings> PhysicsWorld::earlier_readings(const PhysicsState& state,
                                                                std::size_t vehicle) const {
  const PhysicsVehicle& of = vehicles_[vehicle];
  const auto room = state.earlier().subspan(of.first_earlier, of.earlier);
  const auto kept = std::ranges::find(room, 0u, &EarlierReadings::kept);
  return room.first(static_cast<std::size_t>(kept - room.begin()));
}

const rov::BatteryState* PhysicsWorld::battery(const PhysicsState& state,
                                               std::size_t vehicle) const {
  const auto& at = vehicles_[vehicle].battery;
  return at ? &state.batteries()[*at] : nullptr;
}

StateFormat PhysicsWorld::state_format() const {
  std::vector<std::string> names{"simulation"};
  names.insert(names.end(), sources_.begin(), sources_.end());
  return {scene_hash_, seed_, step_s_, start(), start_inputs(), std::move(names)};
}

std::unique_ptr<PhysicsSimulation> PhysicsWorld::simulation(sim::SimulationOptions options,
                                                            unsigned threads) const {
  options.step_s = step_s_;
  // A scene may have more streams than an inbox usually keeps samples.
  auto inbox = std::make_unique<SampleInbox>(
      streams_, std::max<std::size_t>(SampleInbox::kCapacity, streams_.size()));
  for (const std::string& name : sources_) NERITIC_CHECK(inbox->open(name).ok(), "{}", name);
  return std::make_unique<PhysicsSimulation>(
      options, start(), start_inputs(), std::move(inbox), step_function(threads),
      [this](PhysicsInputs& inputs, const Sample& sample, std::uint64_t step) {
        apply(inputs, sample, step);
      });
}

double PhysicsWorld::wash_m_s(const PhysicsState& state, const Vec3& place_m) const {
  if (!washes_) return 0.0;
  return glm::length(wash_ned_m_s(vehicles_, state, rov::ned_from_world(place_m), water_kg_m3_));
}

GazeTargets::Seen PhysicsWorld::looks_at(const PhysicsState& state, std::size_t human,
                                         double time_s) const {
  const PhysicsHuman& diver = humans_[human];
  const diver::HumanState& now = state.humans()[human].human;
  const diver::Posture posture = diver::posture_of(diver.body, now.limbs.rotation, now.limbs.rate);
  const Vec3 eyes_ned_m = now.root.position_ned_m +
                          now.root.attitude * diver::body_from_eyes(diver.body, posture).position_m;
  return gaze_targets_.look(state, solid_, diver.object, rov::world_from_ned(eyes_ned_m),
                            rov::world_from_ned(now.life.vitals.gaze_ned), time_s);
}

std::vector<std::string> PhysicsWorld::object_names() const {
  std::vector<std::string> names;
  for (const SolidObject& object : solid_objects_) names.push_back(object.name);
  return names;
}

}  // namespace neritic::testbed
