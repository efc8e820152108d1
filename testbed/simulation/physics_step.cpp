// The step (physics_world.hpp): things are grabbed or let go; every vehicle and diver by itself;
// then, one after another, pairs that meet, things that are held and tethers; then every one along
// what is solid; at last free things, gas taken from others, modems. Threads share the second and
// fourth. A vehicle's step has a part between any two instants of its control and its sensors; all
// parts but the last end before pairs meet.
#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "rov/frames.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "testbed/simulation/wash.hpp"
#include "testbed/simulation/water_along.hpp"

namespace neritic::testbed {
namespace {

// The mean rate of the velocity by contacts over dt_s, axes of the body as it now is.
rov::Vec6 felt(const ContactReport& report, double dt_s, const rov::State& body) {
  const Quat body_from_ned = glm::conjugate(body.attitude);
  const double per_s =
      dt_s > 0.0 ? 1.0 / dt_s : 0.0;  // a step of no time is refused: nothing moves
  return per_s * rov::vec6(body_from_ned * report.change_ned.linear(),
                           body_from_ned * report.change_ned.angular());
}

void add_contact(const ContactReport& report, double dt_s, VehicleState& state) {
  ContactState& contact = state.contact;
  contact.near_points = static_cast<std::uint64_t>(report.motion.contacts);
  contact.deepest_m = std::max(contact.deepest_m, report.motion.deepest_m);
  contact.impulse_n_s = report.motion.impulse_n_s;
  contact.acceleration = felt(report, dt_s, state.body);
  contact.touched_steps += report.motion.touched ? 1 : 0;
}

// The number of readings of all sensors together; 0 without any.
std::uint64_t readings_made(const rov::SensorReadings* r) {
  return r ? r->imu.count + r->dvl.count + r->pressure.count + r->heading_rad.count +
                 r->altimeter.count + r->usbl.count
           : 0;
}

double time_at(const sim::StepTime& time, double share) {
  return (static_cast<double>(time.step) + share) * time.step_s;
}

// All of a step keeps its bits.
double length_s(const sim::StepTime& time, const StepPart& part) {
  return part.from == 0.0 && part.to == 1.0 ? time.step_s : (part.to - part.from) * time.step_s;
}

// A thread is worth starting for this many vehicles: their step takes six times as long as the
// thread needs to wake (0.05 ms). A diver counts as many vehicles as it costs
// (tools/benchmark/README.md).
constexpr std::size_t kVehiclesAThread = 100, kVehiclesADiver = 9;

unsigned threads_worth(std::size_t vehicles, std::size_t divers) {
  const std::size_t worth = (vehicles + kVehiclesADiver * divers) / kVehiclesAThread;
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  return static_cast<unsigned>(std::clamp<std::size_t>(worth, 1, cores));
}

// After the step: where the samples put it, or as it was, or where its own track or place has it.
ObjectState next_object(const ObjectState& before, const ObjectInputs& inputs,
                        const sim::StepTime& time) {
  const GroupControl& control = inputs.control.front();
  ObjectState next = before;
  next.groups.front() = next_group(before.groups.front(), control, time.step, time.step_s);
  const Authority by = acting(next.groups.front());
  next.motion.velocity_m_s = next.motion.angular_velocity_rad_s = Vec3(0.0);
  if (by == Authority::kLive) {
    next.placed = 1;
    next.motion =
        inputs.track.at(static_cast<double>(time.step + 1 - control.heard_step) * time.step_s);
  } else if (by == Authority::kAutopilot) {
    next.placed = 0;
    next.motion = {};
  }
  return next;
}

// After the step: the limbs of an object whose poses and joints come from elsewhere.
LimbState next_limbs(const LimbState& before, const LimbTrack& track, const ObjectState& object,
                     double hold_s, const sim::StepTime& time) {
  LimbState next = before;
  const Authority by = acting(object.groups.front());
  const double since_s = static_cast<double>(time.step + 1 - track.taken_step) * time.step_s;
  // As long as the group's own silence counts (next_group).
  const double silent_s = static_cast<double>(time.step - track.taken_step) * time.step_s;
  if (by == Authority::kLive && track.taken > 0 && silent_s <= hold_s) {
    next.joints = track.at(since_s);
    next.shown = 1;
  } else if (by != Authority::kNobody) {
    next = {};
  }
  return next;
}

// Bit i: the scene has a file for group i.
std::uint64_t recorded_groups(const PhysicsHuman& human) {
  const auto bit = [](DiverGroup group) {
    return std::uint64_t{1} << static_cast<std::uint64_t>(group);
  };
  return (human.recording ? bit(DiverGroup::kBody) : 0) |
         (human.buttons ? bit(DiverGroup::kButtons) : 0);
}

// Points of one body, thinned or not: more are seldom near at once.
constexpr std::size_t kRoomForContacts = 256;

}  // namespace

PhysicsState PhysicsWorld::start() const {
  PhysicsState state(vehicles_.size(), humans_.size(), sensing_, navigating_, objects_.size(),
                     modems_.all().size(), conditions_, regulators_, things_.things().size(),
                     things_.grips().size(), limbs_, tethers_.all().size(), tethers_.node_count(),
                     batteries_, earlier_, turning_);
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    state.vehicles()[i].body = vehicles_[i].start;
    if (const auto at = vehicles_[i].battery)
      state.batteries()[*at] = rov::start_battery(*vehicles_[i].file.parameters.battery);
  }
  for (std::size_t i = 0; i < humans_.size(); ++i) {
    state.humans()[i] = humans_[i].start;
    start_condition(humans_[i], state, humans_[i].start);
  }
  things_.start(state);
  if (tethers_.any()) tethers_.start(solid_, state);
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    sense(i, {}, -1.0, 0.0, state);
    start_navigation(i, state);
    state.vehicles()[i].mission = mission_start(known_state(state, i, 0.0));
  }
  return state;
}

void PhysicsWorld::apply(PhysicsInputs& inputs, const Sample& sample, std::uint64_t step) const {
  const Stream& stream = streams_[sample.header.stream];
  if (const ModemSend* message = std::get_if<ModemSend>(&sample.payload)) {
    inputs.modems()[*modems_.find(stream.sort, stream.owner)].add(*message, step);
    return;
  }
  if (const GripUse* use = std::get_if<GripUse>(&sample.payload)) {
    inputs.grips()[*things_.find(stream.sort, stream.owner)].use = *use;
    return;
  }
  if (const RegulatorUse* use = std::get_if<RegulatorUse>(&sample.payload)) {
    inputs.regulators()[humans_[stream.owner].regulator->place].use = *use;
    return;
  }
  if (stream.sort == OwnerSort::kDiver)
    testbed::apply(inputs.humans()[stream.owner], sample, step,
                   recorded_groups(humans_[stream.owner]));
  else if (stream.sort == OwnerSort::kVehicle)
    testbed::apply(inputs.vehicles()[stream.owner], sample, step);
  else
    testbed::apply(
        inputs.objects()[stream.owner], sample, step,
        objects_[stream.owner].limbs ? &inputs.limbs()[*objects_[stream.owner].limbs] : nullptr);
}

rov::RayQuery PhysicsWorld::rays() const {
  const auto cast = [](const void* solid, const Vec3& origin_ned_m, const Vec3& direction_ned,
                       double most_m) {
    const auto hit = static_cast<const sim::StaticWorld*>(solid)->cast(
        rov::world_from_ned(origin_ned_m), rov::world_from_ned(direction_ned), most_m);
    return hit ? hit->distance_m : std::numeric_limits<double>::infinity();
  };
  return {cast, &solid_};
}

PhysicsState PhysicsWorld::step(const PhysicsState& before, const PhysicsInputs& inputs,
                                const sim::StepTime& time) const {
  PhysicsState after = before;
  StepScratch scratch = this->scratch(1);
  step(before, inputs, time, scratch, after);
  return after;
}

StepScratch PhysicsWorld::scratch(unsigned threads) const {
  StepScratch scratch{std::vector<VehicleScratch>(vehicles_.size()),
                      std::vector<HumanScratch>(humans_.size()),
                      std::vector<ThingWater>(things_.things().size()),
                      {},
                      {},
                      {},
                      std::vector<sim::ContactMemory>(threads),
                      sim::Workers(threads)};
  for (std::size_t i = 0; i < vehicles_.size(); ++i)
    if (vehicles_[i].near_radius_m > 0.0) scratch.vehicles[i].near = {vehicles_[i].vehicle};
  scratch.finder.begin(vehicles_.size(), vehicles_.size() + humans_.size());
  if (solid_.counts().things > 0)
    for (sim::ContactMemory& memory : scratch.contacts) memory.reserve(kRoomForContacts);
  return scratch;
}

void PhysicsWorld::step(const PhysicsState& before, const PhysicsInputs& inputs,
                        const sim::StepTime& time, StepScratch& scratch,
                        PhysicsState& after) const {
  after = before;
  const StepCall call{before, inputs, time, scratch, after};
  const std::size_t vehicles = vehicles_.size(), humans = humans_.size();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    after.objects()[i] = next_object(before.objects()[i], inputs.objects()[i], time);
    if (const auto k = objects_[i].limbs)
      after.limbs()[*k] = next_limbs(before.limbs()[*k], inputs.limbs()[*k], after.objects()[i],
                                     inputs.objects()[i].control.front().hold_s, time);
  }
  if (things_.any()) things_.choose(humans_, inputs, before, after);
  // Each writes its own part of scratch and after, and reads before. Divers, which cost more, come
  // first: no thread is left with one at the end.
  scratch.workers.run(humans + vehicles, [&](std::size_t i, unsigned thread) {
    i < humans ? begin_human(call, i) : begin_vehicle(call, i - humans, thread);
  });
  if (vehicles + humans > 1) part_all(call);
  if (things_.any()) pull_all(call);
  if (tethers_.any()) step_tethers(call);
  scratch.workers.run(humans + vehicles, [&](std::size_t i, unsigned thread) {
    i < humans ? finish_human(call, i, thread) : finish_vehicle(call, i - humans, thread);
  });
  if (things_.any())
    things_.finish(humans_, solid_, scratch.thing_waters, water_kg_m3_, time.step_s,
                   scratch.contacts.front(), after);
  if (regulators_ > 0)
    for (std::size_t k = 0; k < humans; ++k)
      settle_gas(humans_, k, scratch.humans[k].taken_moles, after);
  if (!modems_.all().empty()) step_modems(call);
}

// The currents at things that move; each that is held pulls at its holder.
void PhysicsWorld::pull_all(const StepCall& call) const {
  for (std::size_t i = 0; i < things_.things().size(); ++i) {
    const ObjectState& object = call.after.objects()[things_.things()[i].object];
    const ThingState& thing = call.after.things()[i];
    if (thing.rests != 0 || acting(object.groups.front()) == Authority::kLive) continue;
    ThingWater& water = call.scratch.thing_waters[i];
    const Vec3 at_ned_m = rov::ned_from_world(object.motion.pose.position_m);
    const diver::WaterFlow flow = waves_
                                      ? water_along(current_, waves_, at_ned_m,
                                                    rov::ned_from_world(object.motion.velocity_m_s),
                                                    call.time.time_s(), call.time.step_s)
                                      : water_ned(at_ned_m, call.time.time_s());
    water = {rov::world_from_ned(flow.current_m_s), flow.head_m,
             rov::world_from_ned(flow.acceleration_m_s2)};
    if (washes_)
      water.current_m_s +=
          rov::world_from_ned(wash_ned_m_s(vehicles_, call.before, at_ned_m, water_kg_m3_));
    const std::uint64_t holder = thing.holder;
    if (holder == 0) continue;
    const PhysicsGrip& grip = things_.grips()[holder - 1];
    const auto pull = [&](const sim::InverseMass& inverse_mass, sim::BodyMotion& free) {
      things_.pull(i, humans_, {inverse_mass, free}, water, water_kg_m3_, call.time.step_s,
                   call.after);
    };
    if (grip.sort == OwnerSort::kVehicle) {
      VehicleScratch& own = call.scratch.vehicles[grip.owner];
      sim::PairBody body = pair_body(whole_step(call, grip.owner), own.free);
      pull(body.inverse_mass, body.free);
      set_motion(body.free, own.free);
      own.pulled = true;
    } else {
      HumanStep& moving = call.scratch.humans[grip.owner].moving;
      pull(moving.inverse_mass, moving.free);
    }
  }
}

// Each tether pulls at its vehicle.
void PhysicsWorld::step_tethers(const StepCall& call) const {
  for (std::size_t i = 0; i < tethers_.all().size(); ++i) {
    const std::size_t vehicle = tethers_.all()[i].vehicle;
    VehicleScratch& own = call.scratch.vehicles[vehicle];
    const rov::State& was = call.before.vehicles()[vehicle].body;
    sim::PairBody body = pair_body(whole_step(call, vehicle), own.free);
    const Motion before = motion_of(call.before.vehicles()[vehicle]);
    const auto current = [&](const Vec3& at_ned_m) {
      return water_ned(at_ned_m, call.time.time_s()).current_m_s;
    };
    if (!tethers_.step(i, solid_, current, call.before, call.time,
                       {body.inverse_mass, rov::world_pose(was.position_ned_m, was.attitude),
                        before.velocity_m_s, before.angular_velocity_rad_s, body.free},
                       call.scratch.tether, call.scratch.contacts.front(), call.after))
      continue;
    set_motion(body.free, own.free);
    own.pulled = true;
  }
}

void PhysicsWorld::step_modems(const StepCall& call) const {
  modems_.step(call.before, call.inputs, call.time, seed_, call.after);
}

// For what meets in it.
VehicleStep PhysicsWorld::whole_step(const StepCall& call, std::size_t i) const {
  const PhysicsVehicle& vehicle = vehicles_[i];
  const VehicleScratch& own = call.scratch.vehicles[i];
  return {vehicle.kind.solid,
          own.near.empty() ? vehicle.vehicle : own.near.front(),
          call.before.vehicles()[i].body,
          call.scratch.vehicles[i].acting,
          call.time.step_s,
          method_};
}

VehicleStep PhysicsWorld::part_step(const StepCall& call, std::size_t i) const {
  const PhysicsVehicle& vehicle = vehicles_[i];
  const VehicleScratch& own = call.scratch.vehicles[i];
  return {vehicle.kind.solid,
          own.near.empty() ? vehicle.vehicle : own.near.front(),
          call.after.vehicles()[i].body,
          own.acting,
          length_s(call.time, own.part),
          method_};
}

void PhysicsWorld::begin_vehicle(const StepCall& call, std::size_t i, unsigned thread) const {
  VehicleScratch& own = call.scratch.vehicles[i];
  VehicleState& state = call.after.vehicles()[i];
  const VehicleInputs& inputs = call.inputs.vehicles()[i];
  own.parted = own.pulled = false;
  own.contact = {};
  std::ranges::fill(call.after.earlier().subspan(vehicles_[i].first_earlier, vehicles_[i].earlier),
                    EarlierReadings{});
  for (std::size_t k = 0; k < kVehicleGroups; ++k)
    state.groups[k] =
        next_group(state.groups[k], inputs.control[k], call.time.step, call.time.step_s);
  for (own.part.from = 0.0;; own.part.from = own.part.to) {
    own.part.to = next_of(vehicles_[i].kind.model.instants, call.time.step, own.part.from);
    begin_part(call, i);
    if (own.part.to == 1.0) break;
    end_part(call, i, thread);
  }
  own.alone_ned = velocity_ned(own.free);
}

void PhysicsWorld::begin_part(const StepCall& call, std::size_t i) const {
  const PhysicsVehicle& vehicle = vehicles_[i];
  VehicleScratch& own = call.scratch.vehicles[i];
  VehicleState& state = call.after.vehicles()[i];
  const double from_s = time_at(call.time, own.part.from);
  const Instants& control = vehicle.kind.model.instants.front();
  const bool due =
      control.at(call.time.step, own.part.from) ||
      (own.part.from == 0.0 && forces_came(call.inputs.vehicles()[i], state, call.time.step));
  if (due && !steer(i, call, from_s)) ++state.body.refused_inputs;
  own.acting =
      acting_on(vehicle, call.inputs.vehicles()[i], state, from_s, length_s(call.time, own.part));
  if (!own.near.empty()) add_near_bounds(i, state.body, from_s, own);
  own.free = free_step(part_step(call, i));
}

void PhysicsWorld::begin_human(const StepCall& call, std::size_t k) const {
  const diver::RootState& root = call.before.humans()[k].human.root;
  diver::WaterFlow water =
      water_along(current_, waves_, root.position_ned_m, root.attitude * root.velocity.linear(),
                  call.time.time_s(), call.time.step_s);
  if (washes_)
    water.current_m_s += wash_on_diver_ned_m_s(vehicles_, humans_[k], call.before.humans()[k],
                                               call.before, water_kg_m3_);
  const PhysicsHuman& human = humans_[k];
  Ability able = ability_of(human, call.before);
  if (things_.any())
    able.hand_to_m = things_.reaches_for_m(static_cast<std::uint32_t>(k), humans_, call.before);
  HumanPhysics& after = call.after.humans()[k];
  auto borrowed = borrow(humans_, k, able, call.inputs, call.before, call.time.step_s, call.after);
  HumanScratch& own = call.scratch.humans[k];
  own = {free_human(human, call.inputs.humans()[k], water, call.time.step, call.time.step_s, able,
                    borrowed ? &*borrowed : nullptr, after),
         false, borrowed ? borrowed->taken_moles : 0.0};
  if (human.regulator) blow_off(human, call.inputs, call.time, call.after, after);
  if (human.condition)
    step_condition(human, borrowed ? &borrowed->place.mix : nullptr, call.time.step_s, call.after,
                   after);
}

// Pairs that meet part, in a fixed order.
void PhysicsWorld::part_all(const StepCall& call) const {
  StepScratch& scratch = call.scratch;
  PairFinder& finder = scratch.finder;
  const std::size_t vehicles = vehicles_.size(), bodies = vehicles + humans_.size();
  const auto sphere = [&](std::size_t i) -> PairSphere {
    const sim::PairBody body =
        i < vehicles ? pair_body(whole_step(call, i), scratch.vehicles[i].free)
                     : pair_body(humans_[i - vehicles], scratch.humans[i - vehicles].moving);
    return {body.before.position_m, sim::pair_reach_m(body)};
  };
  finder.begin(vehicles, bodies);
  for (std::size_t i = 0; i < bodies; ++i) finder.set(i, sphere(i));
  finder.find();
  while (const auto pair = finder.next()) {
    if (!part(call, pair->first, pair->second)) continue;
    for (const std::size_t body : {pair->first, pair->second})
      finder.set_reach(body, sphere(body).reach_m);
  }
}

// Whether two bodies touched: two vehicles, a diver and a vehicle, or two divers.
bool PhysicsWorld::part(const StepCall& call, std::size_t a, std::size_t b) const {
  const std::size_t vehicles = vehicles_.size();
  StepScratch& scratch = call.scratch;
  if (a < vehicles) {
    VehicleScratch &one = scratch.vehicles[a], &two = scratch.vehicles[b];
    if (!part_vehicles(whole_step(call, a), one.free, whole_step(call, b), two.free, scratch.pair))
      return false;
    one.parted = two.parted = true;
    return true;
  }
  const std::size_t k = a - vehicles;
  HumanScratch& own = scratch.humans[k];
  if (b < vehicles) {
    VehicleScratch& vehicle = scratch.vehicles[b];
    if (!part_from_vehicle(humans_[k], own.moving, whole_step(call, b), vehicle.free, scratch.pair))
      return false;
    vehicle.parted = own.parted = true;
    return true;
  }
  HumanScratch& other = scratch.humans[b - vehicles];
  if (!part_humans(humans_[k], own.moving, humans_[b - vehicles], other.moving, call.time.step_s,
                   scratch.pair))
    return false;
  own.parted = other.parted = true;
  return true;
}

// The rest of the part that begin_part() began: contacts, then what the vehicle measures.
void PhysicsWorld::end_part(const StepCall& call, std::size_t i, unsigned thread) const {
  VehicleScratch& own = call.scratch.vehicles[i];
  VehicleState& state = call.after.vehicles()[i];
  const VehicleStep step = part_step(call, i);
  ContactReport report;
  state.body = step_among(solid_, step, own.free, own.parted || own.pulled,
                          call.scratch.contacts[thread], &report);
  if (own.parted) report.motion.touched = true;
  if (own.parted || own.pulled) {
    report.change_ned = report.change_ned + velocity_ned(own.free) - own.alone_ned;
  }
  const double to_s = time_at(call.time, own.part.to);
  const std::uint64_t read = readings_made(readings(call.after, i));
  sense(i, felt(report, step.dt_s, state.body), to_s - step.dt_s, to_s, call.after);
  if (own.part.to < 1.0) keep_readings(i, read, call.after);
  navigate(i, to_s, call.after);
  add_part(report, own.contact);
}

void PhysicsWorld::finish_vehicle(const StepCall& call, std::size_t i, unsigned thread) const {
  end_part(call, i, thread);
  add_contact(call.scratch.vehicles[i].contact, call.time.step_s, call.after.vehicles()[i]);
  const PhysicsVehicle& vehicle = vehicles_[i];
  if (!vehicle.turning && !vehicle.battery) return;
  const rov::State& body = call.after.vehicles()[i].body;
  const auto all_n = rov::thruster_forces(vehicle.vehicle, body, body.held);
  const auto forces_n = std::span(all_n).first(vehicle.vehicle.thruster_count);
  if (const auto at = vehicle.turning)
    call.after.propellers()[*at] =
        next_propellers(vehicle.vehicle, forces_n, vehicle.water.water_kg_m3, call.time.step_s,
                        call.before.propellers()[*at]);
  if (const auto at = vehicle.battery)
    call.after.batteries()[*at] = rov::step_battery(
        *vehicle.file.parameters.battery, call.before.batteries()[*at], forces_n, call.time.step_s);
}

void PhysicsWorld::finish_human(const StepCall& call, std::size_t k, unsigned thread) const {
  const HumanScratch& own = call.scratch.humans[k];
  const double head_m = waves_ ? waves_
                                     ->flow(own.moving.free.world_from_body.position_m,
                                            call.time.time_s() + call.time.step_s)
                                     .head_m
                               : 0.0;
  end_human(humans_[k], solid_, own.moving, own.parted, head_m, call.time.step, call.time.step_s,
            ability_of(humans_[k], call.before), call.scratch.contacts[thread],
            call.after.humans()[k]);
}

// The samples of the vehicle's sensors that are due in (from_s, to_s], of the state at to_s, whose
// velocity contacts changed at this rate.
void PhysicsWorld::sense(std::size_t index, const rov::Vec6& contact, double from_s, double to_s,
                         PhysicsState& state) const {
  const PhysicsVehicle& vehicle = vehicles_[index];
  if (!vehicle.readings) return;
  rov::SensorWorld world = sensor_world(index);
  if (waves_)
    world.water.head_m =
        waves_->flow(rov::world_from_ned(state.vehicles()[index].body.position_ned_m), to_s).head_m;
  rov::update_readings(vehicle.file.sensors, world, vehicle.vehicle, state.vehicles()[index].body,
                       contact, from_s, to_s, state.readings()[*vehicle.readings]);
}

// Keeps what its sensors have read in this part of the step, whose next part may read anew.
void PhysicsWorld::keep_readings(std::size_t index, std::uint64_t read_before,
                                 PhysicsState& state) const {
  const PhysicsVehicle& vehicle = vehicles_[index];
  const rov::SensorReadings* now = readings(state, index);
  if (vehicle.earlier == 0 || readings_made(now) == read_before) return;
  const auto room = state.earlier().subspan(vehicle.first_earlier, vehicle.earlier);
  const auto free = std::ranges::find(room, 0u, &EarlierReadings::kept);
  NERITIC_CHECK(free != room.end(), "{}: {} readings of a step", vehicle.name, room.size());
  *free = {1, *now};
}

rov::SensorWorld PhysicsWorld::sensor_world(std::size_t vehicle) const {
  return {rays(), seed_, vehicle, vehicles_[vehicle].water};
}

PhysicsSimulation::Step PhysicsWorld::step_function(unsigned threads) const {
  if (threads == 0) threads = threads_worth(vehicles_.size(), humans_.size());
  return [this, scratch = scratch(threads)](
             const PhysicsState& before, const PhysicsInputs& inputs, const sim::StepTime& time,
             PhysicsState& after) mutable { step(before, inputs, time, scratch, after); };
}

}  // namespace neritic::testbed
