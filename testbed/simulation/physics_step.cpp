// The step (physics_world.hpp).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rov/frames.hpp"
#include "rov/thrust_priority.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "testbed/simulation/surface.hpp"

namespace neritic::testbed {
namespace {

void add_contact(const ContactReport& report, double dt_s, VehicleState& state) {
  const Quat body_from_ned = glm::conjugate(state.body.attitude);
  ContactState& contact = state.contact;
  contact.near_points = static_cast<std::uint64_t>(report.motion.contacts);
  contact.deepest_m = std::max(contact.deepest_m, report.motion.deepest_m);
  contact.impulse_n_s = report.motion.impulse_n_s;
  const double per_s =
      dt_s > 0.0 ? 1.0 / dt_s : 0.0;  // a step of no time is refused: nothing moves
  contact.acceleration = per_s * rov::vec6(body_from_ned * report.change_ned.linear(),
                                           body_from_ned * report.change_ned.angular());
}

Authority authority_of(const VehicleInputs& inputs, const VehicleState& state, VehicleGroup group) {
  return acting(inputs.of(group), state.groups[static_cast<std::size_t>(group)].phase);
}

std::uint64_t failed_thrusters(const PhysicsVehicle& vehicle, const VehicleInputs& inputs,
                               const VehicleState& state) {
  switch (authority_of(inputs, state, VehicleGroup::kFault)) {
    case Authority::kLive:
      return inputs.fault.failed;
    case Authority::kNobody:
      return 0;
    default:
      return vehicle.failed_thrusters;
  }
}

}  // namespace

bool PhysicsWorld::control_due(std::size_t vehicle, std::uint64_t step) const {
  if (step == 0) return true;
  const double periods_a_step = step_s_ / vehicles_[vehicle].file.gains.period_s;
  const auto periods = [&](std::uint64_t steps) {
    return std::floor(static_cast<double>(steps) * periods_a_step + 1e-9);
  };
  return periods(step) != periods(step - 1);
}

PhysicsState PhysicsWorld::start() const {
  PhysicsState state(vehicles_.size(), humans_.size(), sensing_);
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    state.vehicles()[i].body = vehicles_[i].start;
    state.vehicles()[i].mission = mission_start(vehicles_[i].start);
  }
  for (std::size_t i = 0; i < humans_.size(); ++i) state.humans()[i] = humans_[i].start;
  for (std::size_t i = 0; i < vehicles_.size(); ++i) sense(i, -1.0, 0.0, state);
  return state;
}

void PhysicsWorld::apply(PhysicsInputs& inputs, const Sample& sample, std::uint64_t step) const {
  const Stream& stream = streams_[sample.header.stream];
  if (stream.sort == OwnerSort::kDiver)
    testbed::apply(inputs.humans()[stream.owner], sample, step);
  else if (stream.sort == OwnerSort::kVehicle)
    testbed::apply(inputs.vehicles()[stream.owner], sample, step);
}

Vec3 PhysicsWorld::current_ned_m_s(const Vec3& position_ned_m, double time_s) const {
  if (!current_) return Vec3(0.0);
  return rov::ned_from_world(
      sim::sample(*current_, rov::world_from_ned(position_ned_m), time_s).velocity_m_s);
}

// The current where the thing will be half way through the step, how that changes on its way, and
// the water's own acceleration: to second order in the step. A grid may jump within the thing's own
// length: that is no acceleration of all the water around.
diver::WaterFlow PhysicsWorld::water_along(const Vec3& position_ned_m, const Vec3& velocity_ned_m_s,
                                           double time_s, double dt_s) const {
  if (!current_) return {};
  const Vec3 velocity_m_s = rov::world_from_ned(velocity_ned_m_s);
  const sim::CurrentSample water =
      sim::sample(*current_, rov::world_from_ned(position_ned_m) + 0.5 * dt_s * velocity_m_s,
                  time_s + 0.5 * dt_s);
  const auto change_along = [&](const Vec3& way_m_s) {
    static_assert(rov::kMostWaterAcceleration_m_s2 == diver::kMostWaterAcceleration_m_s2);
    constexpr double kMost = rov::kMostWaterAcceleration_m_s2;
    return rov::ned_from_world(
        glm::clamp(water.rate_m_s2 + water.gradient_per_s * way_m_s, Vec3(-kMost), Vec3(kMost)));
  };
  const Vec3 change = change_along(velocity_m_s);
  return {rov::ned_from_world(water.velocity_m_s) - 0.5 * dt_s * change, change,
          change_along(water.velocity_m_s)};
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
  StepScratch scratch = this->scratch();
  step(before, inputs, time, scratch, after);
  return after;
}

StepScratch PhysicsWorld::scratch() const {
  return {std::vector<VehicleScratch>(vehicles_.size()), std::vector<HumanScratch>(humans_.size())};
}

void PhysicsWorld::step(const PhysicsState& before, const PhysicsInputs& inputs,
                        const sim::StepTime& time, StepScratch& scratch,
                        PhysicsState& after) const {
  after = before;
  const auto vehicles = after.vehicles();
  const auto humans = after.humans();
  const double time_s = time.time_s(), dt_s = time.step_s;
  const auto step_of = [&](std::size_t i) {
    return VehicleStep{vehicles_[i].solid,
                       vehicles_[i].vehicle,
                       before.vehicles()[i].body,
                       scratch.vehicles[i].acting,
                       dt_s,
                       method_};
  };
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    VehicleScratch& own = scratch.vehicles[i];
    own.parted = false;
    for (std::size_t k = 0; k < kVehicleGroups; ++k)
      vehicles[i].groups[k] =
          next_group(vehicles[i].groups[k], inputs.vehicles()[i].control[k], time.step, dt_s);
    own.refused =
        control_due(i, time.step) && !steer(i, before, inputs.vehicles()[i], time_s, vehicles[i]);
    own.acting = acting_on(vehicles_[i], inputs.vehicles()[i], vehicles[i], time_s, dt_s);
    own.free = free_step(step_of(i));
    own.alone_ned = velocity_ned(own.free);
  }
  for (std::size_t k = 0; k < humans.size(); ++k) {
    const diver::RootState& root = before.humans()[k].human.root;
    const diver::WaterFlow water =
        water_along(root.position_ned_m, root.attitude * root.velocity.linear(), time_s, dt_s);
    scratch.humans[k] = {
        free_human(humans_[k], inputs.humans()[k], water, time.step, dt_s, humans[k]), false};
  }
  for (std::size_t i = 0; i < vehicles.size(); ++i)
    for (std::size_t j = i + 1; j < vehicles.size(); ++j) {
      VehicleScratch &a = scratch.vehicles[i], &b = scratch.vehicles[j];
      if (part_vehicles(step_of(i), a.free, step_of(j), b.free)) a.parted = b.parted = true;
    }
  for (std::size_t k = 0; k < humans.size(); ++k) {
    HumanScratch& own = scratch.humans[k];
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      VehicleScratch& vehicle = scratch.vehicles[i];
      if (part_from_vehicle(humans_[k], own.moving, step_of(i), vehicle.free))
        vehicle.parted = own.parted = true;
    }
    for (std::size_t m = k + 1; m < humans.size(); ++m) {
      HumanScratch& other = scratch.humans[m];
      if (part_humans(humans_[k], own.moving, humans_[m], other.moving, dt_s))
        own.parted = other.parted = true;
    }
  }
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const VehicleScratch& own = scratch.vehicles[i];
    ContactReport report;
    vehicles[i].body = step_among(solid_, step_of(i), own.free, own.parted, &report);
    vehicles[i].body.refused_inputs += own.refused ? 1 : 0;
    if (own.parted) report.change_ned = report.change_ned + velocity_ned(own.free) - own.alone_ned;
    add_contact(report, dt_s, vehicles[i]);
    vehicles[i].contact.touched_steps += report.motion.touched || own.parted ? 1 : 0;
    const double end_s = sim::StepTime{time.step + 1, dt_s}.time_s();
    sense(i, end_s - dt_s, end_s, after);
  }
  for (std::size_t k = 0; k < humans.size(); ++k)
    end_human(humans_[k], solid_, scratch.humans[k].moving, scratch.humans[k].parted, time.step,
              dt_s, humans[k]);
}

// New commands for the thrusters: of a pilot's wrench, else of a setpoint from outside, else of the
// mission. False where the commands are no numbers: the last ones hold.
bool PhysicsWorld::steer(std::size_t index, const PhysicsState& all, const VehicleInputs& inputs,
                         double time_s, VehicleState& state) const {
  if (!sim::all_finite(inputs)) return false;
  const PhysicsVehicle& vehicle = vehicles_[index];
  const Authority wrench_by = authority_of(inputs, state, VehicleGroup::kWrench);
  const Authority setpoint_by = authority_of(inputs, state, VehicleGroup::kSetpoint);
  const bool piloted = wrench_by == Authority::kLive;
  const bool given = setpoint_by == Authority::kLive;
  const bool rests = wrench_by == Authority::kNobody || setpoint_by == Authority::kNobody;
  if (!piloted && !given && (rests || !vehicle.mission)) {
    state.command_n = {};
    return true;
  }
  rov::Setpoint setpoint =
      piloted ? piloted_setpoint(inputs.wrench.wrench, state.body, state.mission)
      : given ? given_setpoint(inputs.setpoint, state.mission)
              : vehicle.mission->update(all, state.body, time_s, state.mission);
  if (piloted) setpoint.pilot = inputs.wrench.wrench;
  rov::ControlState control{state.integral};
  const auto commands_by = [&](const rov::Allocator& allocator) {
    return (piloted ? rov::piloted_inputs : rov::level_inputs)(
        vehicle.vehicle, allocator, vehicle.file.gains, setpoint, state.body, control);
  };
  const std::uint64_t failed = failed_thrusters(vehicle, inputs, state);
  rov::Inputs commands = failed == vehicle.failed_thrusters
                             ? commands_by(vehicle.allocator)
                             : commands_by(rov::Allocator(vehicle.vehicle, failed));
  rov::drive(vehicle.file, commands);
  if (!sim::all_finite(commands)) return false;
  state.command_n = commands.thruster_n;
  state.integral = control.integral;
  return true;
}

// The samples of the vehicle's sensors that are due in (from_s, to_s], of the state at to_s.
void PhysicsWorld::sense(std::size_t index, double from_s, double to_s, PhysicsState& state) const {
  const PhysicsVehicle& vehicle = vehicles_[index];
  if (!vehicle.readings) return;
  const VehicleState& now = state.vehicles()[index];
  rov::update_readings(vehicle.file.sensors, sensor_world(index), vehicle.vehicle, now.body,
                       now.contact.acceleration, from_s, to_s, state.readings()[*vehicle.readings]);
}

rov::SensorWorld PhysicsWorld::sensor_world(std::size_t vehicle) const {
  return {rays(), seed_, vehicle, vehicles_[vehicle].water};
}

const rov::SensorReadings* PhysicsWorld::readings(const PhysicsState& state,
                                                  std::size_t vehicle) const {
  const auto& at = vehicles_[vehicle].readings;
  return at ? &state.readings()[*at] : nullptr;
}

// What pushes it in the step to come.
rov::Inputs PhysicsWorld::acting_on(const PhysicsVehicle& vehicle, const VehicleInputs& inputs,
                                    const VehicleState& state, double time_s, double dt_s) const {
  rov::Inputs acting;
  acting.thruster_n = state.command_n;
  const diver::WaterFlow water = water_along(
      state.body.position_ned_m, state.body.attitude * state.body.velocity.linear(), time_s, dt_s);
  acting.current_ned_m_s = water.current_m_s;
  acting.current_change_ned_m_s2 = water.change_m_s2;
  acting.water_acceleration_ned_m_s2 = water.acceleration_m_s2;
  acting.tether_anchor_ned_m = vehicle.tether_anchor_ned_m;
  acting.failed_thrusters = failed_thrusters(vehicle, inputs, state);
  apply_surface(vehicle.vehicle, vehicle.top_m, vehicle.bottom_m, state.body, acting);
  return acting;
}

StateFormat PhysicsWorld::state_format() const {
  return {scene_hash_, step_s_, start(), start_inputs()};
}

PhysicsSimulation::Step PhysicsWorld::step_function() const {
  return [this, scratch = scratch()](const PhysicsState& before, const PhysicsInputs& inputs,
                                     const sim::StepTime& time, PhysicsState& after) mutable {
    step(before, inputs, time, scratch, after);
  };
}

std::unique_ptr<PhysicsSimulation> PhysicsWorld::simulation(sim::SimulationOptions options) const {
  options.step_s = step_s_;
  // A scene may have more streams than an inbox usually keeps samples.
  auto inbox = std::make_unique<SampleInbox>(
      streams_, std::max<std::size_t>(SampleInbox::kCapacity, streams_.size()));
  for (const std::string& name : sources_) NERITIC_CHECK(inbox->open(name).ok(), "{}", name);
  return std::make_unique<PhysicsSimulation>(
      options, start(), start_inputs(), std::move(inbox), step_function(),
      [this](PhysicsInputs& inputs, const Sample& sample, std::uint64_t step) {
        apply(inputs, sample, step);
      });
}

}  // namespace neritic::testbed
