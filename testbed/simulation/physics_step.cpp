// The step (physics_world.hpp).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rov/frames.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "testbed/simulation/surface.hpp"

namespace neritic::testbed {
namespace {

// Of a wrench that pushes the share for which the thrusters have room beside what holds the vehicle
// level: at full thrust they would have none left, and it would overturn.
rov::Vec6 with_room(const rov::Vehicle& vehicle, const rov::Allocator& allocator,
                    const rov::Vec6& holding, const rov::Vec6& push) {
  const auto held_n = allocator.allocate(holding).wanted_n;
  const auto push_n = allocator.allocate(push).wanted_n;
  double share = 1.0;
  for (std::size_t i = 0; i < vehicle.thruster_count; ++i) {
    if (push_n[i] == 0.0) continue;
    const double limit_n =
        push_n[i] > 0.0 ? vehicle.thrusters[i].max_n : vehicle.thrusters[i].min_n;
    share = std::min(share, (limit_n - held_n[i]) / push_n[i]);
  }
  return std::max(0.0, share) * push;
}

// What a mission's push leaves of the thrusters is little where the setpoint is far away, and
// moving fast the water turns a vehicle broadside (the Munk moment, v x M_A v; Fossen 2011,
// eq. 6.43) more than its gains hold: cut like all the rest, its moments would not keep it off its
// nose. So they come first, the Munk moment given on top.
rov::Vec6 level_first(const rov::Vehicle& vehicle, const rov::Allocator& allocator,
                      const rov::Vec6& wrench, const rov::State& body) {
  const Vec3 munk = glm::cross(body.velocity.linear(), (vehicle.mass * body.velocity).linear());
  const rov::Vec6 moments = rov::vec6(Vec3(0.0), wrench.angular() + munk);
  return moments + with_room(vehicle, allocator, moments, rov::vec6(wrench.linear(), Vec3(0.0)));
}

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
  PhysicsState state;
  state.vehicle_count = vehicles_.size();
  state.human_count = humans_.size();
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    state.vehicles[i].body = vehicles_[i].start;
    state.vehicles[i].mission = mission_start(vehicles_[i].start);
  }
  for (std::size_t i = 0; i < humans_.size(); ++i) state.humans[i] = humans_[i].start;
  return state;
}

PhysicsInputs PhysicsWorld::start_inputs() const {
  PhysicsInputs inputs;
  for (std::size_t i = 0; i < vehicles_.size(); ++i)
    inputs.vehicles[i].failed_thrusters = vehicles_[i].failed_thrusters;
  return inputs;
}

void PhysicsWorld::apply(PhysicsInputs& inputs, const PhysicsMessage& message) {
  if (message.is_human != 0) {
    if (message.vehicle < kMaxHumans) inputs.humans[message.vehicle] = message.steering;
  } else if (message.vehicle < kMaxVehicles) {
    inputs.vehicles[message.vehicle] = message.inputs;
  }
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

PhysicsState PhysicsWorld::step(const PhysicsState& state, const PhysicsInputs& inputs,
                                double dt_s) const {
  PhysicsState next = state;
  ++next.step;
  const double time_s = static_cast<double>(state.step) * dt_s;
  const std::size_t count = vehicles_.size();
  std::array<rov::Inputs, kMaxVehicles> acting;
  std::array<rov::State, kMaxVehicles> free;
  std::array<bool, kMaxVehicles> parted{}, refused{};
  std::array<rov::Vec6, kMaxVehicles>
      alone_ned;  // velocities as if there were no other vehicle or diver
  const auto step_of = [&](std::size_t i) {
    return VehicleStep{
        vehicles_[i].solid, vehicles_[i].vehicle, state.vehicles[i].body, acting[i], dt_s, method_};
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (control_due(i, state.step))
      refused[i] = !steer(i, state, inputs.vehicles[i], time_s, next.vehicles[i]);
    acting[i] = acting_on(vehicles_[i], inputs.vehicles[i], next.vehicles[i], time_s, dt_s);
    free[i] = free_step(step_of(i));
    alone_ned[i] = velocity_ned(free[i]);
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j)
      if (part_vehicles(step_of(i), free[i], step_of(j), free[j])) parted[i] = parted[j] = true;
  std::array<HumanStep, kMaxHumans> moving;
  std::array<bool, kMaxHumans> human_parted{};
  const std::size_t humans = humans_.size();
  for (std::size_t k = 0; k < humans; ++k) {
    const diver::RootState& root = state.humans[k].human.root;
    const diver::WaterFlow water =
        water_along(root.position_ned_m, root.attitude * root.velocity.linear(), time_s, dt_s);
    moving[k] = free_human(humans_[k], inputs.humans[k], water, state.step, dt_s, next.humans[k]);
  }
  for (std::size_t k = 0; k < humans; ++k) {
    for (std::size_t i = 0; i < count; ++i)
      if (part_from_vehicle(humans_[k], moving[k], step_of(i), free[i]))
        parted[i] = human_parted[k] = true;
    for (std::size_t m = k + 1; m < humans; ++m)
      if (part_humans(humans_[k], moving[k], humans_[m], moving[m], dt_s))
        human_parted[k] = human_parted[m] = true;
  }
  for (std::size_t i = 0; i < count; ++i) {
    ContactReport report;
    VehicleState& after = next.vehicles[i];
    after.body = step_among(solid_, step_of(i), free[i], parted[i], &report);
    after.body.refused_inputs += refused[i] ? 1 : 0;
    if (parted[i]) report.change_ned = report.change_ned + velocity_ned(free[i]) - alone_ned[i];
    add_contact(report, dt_s, after);
    after.contact.touched_steps += report.motion.touched || parted[i] ? 1 : 0;
  }
  for (std::size_t k = 0; k < humans; ++k)
    end_human(humans_[k], solid_, moving[k], human_parted[k], state.step, dt_s, next.humans[k]);
  return next;
}

// New commands for the thrusters. False where the inputs are no numbers: the last commands hold.
bool PhysicsWorld::steer(std::size_t index, const PhysicsState& all, const VehicleInputs& inputs,
                         double time_s, VehicleState& state) const {
  if (!sim::all_finite(inputs)) return false;
  const PhysicsVehicle& vehicle = vehicles_[index];
  const bool piloted = inputs.piloted != 0;
  if (!piloted && !vehicle.mission) {
    state.command_n = {};
    return true;
  }
  const rov::Setpoint setpoint =
      piloted ? piloted_setpoint(inputs, state.body, state.mission)
              : vehicle.mission->update(all, state.body, time_s, state.mission);
  rov::ControlState control{state.integral};
  const rov::Vec6 holding =
      rov::control_wrench(vehicle.vehicle, vehicle.file.gains, setpoint, state.body, control);
  rov::Inputs commands;
  const auto allocate = [&](const rov::Allocator& allocator) {
    const rov::Vec6 wrench =
        piloted ? holding + with_room(vehicle.vehicle, allocator, holding, inputs.pilot)
                : level_first(vehicle.vehicle, allocator, holding, state.body);
    commands.thruster_n = allocator.allocate(wrench, vehicle.file.gains.saturation).force_n;
  };
  if (inputs.failed_thrusters == vehicle.failed_thrusters)
    allocate(vehicle.allocator);
  else
    allocate(rov::Allocator(vehicle.vehicle, inputs.failed_thrusters));
  rov::drive(vehicle.file, commands);
  if (!sim::all_finite(commands)) return false;
  state.command_n = commands.thruster_n;
  state.integral = control.integral;
  return true;
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
  acting.failed_thrusters = inputs.failed_thrusters;
  apply_surface(vehicle.vehicle, vehicle.top_m, vehicle.bottom_m, state.body, acting);
  return acting;
}

std::unique_ptr<PhysicsSimulation> PhysicsWorld::simulation(sim::SimulationOptions options) const {
  options.step_s = step_s_;
  return std::make_unique<PhysicsSimulation>(
      options, start(), start_inputs(),
      [this](const PhysicsState& state, const PhysicsInputs& inputs, double dt_s) {
        return step(state, inputs, dt_s);
      },
      [](PhysicsInputs& inputs, const PhysicsMessage& message) { apply(inputs, message); });
}

}  // namespace neritic::testbed
