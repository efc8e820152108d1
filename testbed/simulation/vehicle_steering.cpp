// A vehicle in a step: what it knows of its motion (by its own sensors, or its true state), its
// authorities, thruster commands and the water around it (physics_world.hpp).
#include <algorithm>
#include <array>
#include <cmath>

#include "rov/frames.hpp"
#include "rov/guidance.hpp"
#include "rov/thrust_priority.hpp"
#include "testbed/simulation/periods.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "testbed/simulation/surface.hpp"
#include "testbed/simulation/wash.hpp"
#include "testbed/simulation/water_along.hpp"

namespace neritic::testbed {
namespace {

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

// The wanted velocity, level and to the front, cut to what the thrusters can hold against the drag
// through the water: what is beyond leaves the controller nothing for depth and line. A current
// that helps carries the vehicle on top. Per axis of the way, v from F = d1 v + d2 v^2 with F the
// largest force along it.
VehicleVelocity within_reach(VehicleVelocity wanted, const rov::Vehicle& vehicle,
                             const rov::Allocator& allocator, const rov::State& known) {
  const double speed_m_s = glm::length(wanted.velocity_m_s);
  if (speed_m_s == 0.0) return wanted;
  const Vec3 way = wanted.velocity_m_s / speed_m_s;
  const double force_n = allocator.largest(rov::vec6(way, Vec3(0.0)));
  const auto drag_n = [&](double v_m_s) {
    return glm::dot(rov::drag_of(vehicle, v_m_s * way).linear(), way);
  };
  // Drag at 1 and 2 m/s gives both of its coefficients.
  const double quadratic = 0.5 * drag_n(2.0) - drag_n(1.0), linear = drag_n(1.0) - quadratic;
  const double through_m_s =
      quadratic > 0.0
          ? (std::sqrt(linear * linear + 4.0 * quadratic * force_n) - linear) / (2.0 * quadratic)
      : linear > 0.0 ? force_n / linear
                     : speed_m_s;
  const Vec3 heading_way = rov::heading_attitude(rov::heading_of(known.attitude)) * way;
  const double helps_m_s = std::max(0.0, glm::dot(known.held.current_ned_m_s, heading_way));
  wanted.velocity_m_s = std::min(speed_m_s, through_m_s + helps_m_s) * way;
  return wanted;
}

}  // namespace

bool PhysicsWorld::control_due(std::size_t vehicle, std::uint64_t step) const {
  return period_begins(step, step_s_, vehicles_[vehicle].file.gains.period_s);
}

// Forces of thrusters are not the autopilot's, whose rate the file gives: they act in the step in
// which they come.
bool PhysicsWorld::forces_came(const VehicleInputs& inputs, const VehicleState& state,
                               std::uint64_t step) const {
  return inputs.wrench_by_thrusters != 0 && inputs.of(VehicleGroup::kWrench).heard_step == step &&
         inputs.of(VehicleGroup::kWrench).heard > 0 &&
         authority_of(inputs, state, VehicleGroup::kWrench) == Authority::kLive;
}

// New commands for the thrusters: of a pilot's wrench, else of a setpoint from outside, else of the
// mission. False where the commands are no numbers: the last ones hold.
bool PhysicsWorld::steer(std::size_t index, const StepCall& call, double time_s) const {
  const VehicleInputs& inputs = call.inputs.vehicles()[index];
  VehicleState& state = call.after.vehicles()[index];
  if (!sim::all_finite(inputs)) return false;
  const PhysicsVehicle& vehicle = vehicles_[index];
  const Authority wrench_by = authority_of(inputs, state, VehicleGroup::kWrench);
  const Authority setpoint_by = authority_of(inputs, state, VehicleGroup::kSetpoint);
  const bool piloted = wrench_by == Authority::kLive;
  const bool given = setpoint_by == Authority::kLive;
  const bool rests = wrench_by == Authority::kNobody || setpoint_by == Authority::kNobody;
  if (!piloted && !given && (rests || !vehicle.mission)) {
    state.command_n = {};
    state.mission.speed_n = 0.0;  // learnt of a motion that is over
    return true;
  }
  const rov::State known = known_state(call.after, index, time_s);
  if (piloted && inputs.wrench_by_thrusters != 0) {
    rov::Inputs commands;
    commands.thruster_n = inputs.thrusters.force_n;
    for (std::size_t i = 0; !vehicle.file.curve && i < vehicle.vehicle.thruster_count; ++i) {
      const auto [least_n, most_n] = rov::thruster_limits_n(vehicle.file, i);
      commands.thruster_n[i] = std::clamp(commands.thruster_n[i], least_n, most_n);
    }
    rov::drive(vehicle.file, commands, battery(call.after, index));
    if (!sim::all_finite(commands)) return false;
    drift_with(known, state.mission);
    state.command_n = commands.thruster_n;
    state.integral = {};
    return true;
  }
  const std::uint64_t failed = failed_thrusters(vehicle, inputs, state);
  std::optional<rov::Allocator> without;
  const rov::Allocator& left = failed == vehicle.failed_thrusters
                                   ? vehicle.kind.allocator
                                   : without.emplace(vehicle.vehicle, failed);
  const auto given_by = [&] {
    return inputs.setpoint_by_velocity != 0
               ? velocity_setpoint(within_reach(inputs.velocity, vehicle.vehicle, left, known),
                                   known, vehicle.file.gains.period_s, state.mission)
               : given_setpoint(inputs.setpoint, state.mission);
  };
  rov::Setpoint setpoint = piloted ? piloted_setpoint(inputs.wrench.wrench, known, state.mission)
                           : given
                               ? given_by()
                               : vehicle.mission->update(call.before, known, time_s, state.mission);
  if (piloted)
    setpoint.pilot = inputs.wrench.wrench;
  else
    setpoint = rov::lean(setpoint, known, vehicle.file.gains.period_s, state.mission.lean_ned_m);
  rov::ControlState control{state.integral, state.mission.speed_n};
  rov::Inputs commands =
      rov::level_inputs(vehicle.vehicle, left, vehicle.file.gains, setpoint, known, control);
  const auto asked_n = commands.thruster_n;
  rov::drive(vehicle.file, commands, battery(call.after, index));
  if (setpoint.over_ground) {
    std::array<double, rov::kMaxThrusters> missing_n{};
    for (std::size_t i = 0; i < missing_n.size(); ++i)
      missing_n[i] = asked_n[i] - commands.thruster_n[i];
    rov::unlearn_push(vehicle.vehicle, vehicle.file.gains, setpoint, known,
                      vehicle.kind.allocator.wrench_of(missing_n), control);
  }
  if (!sim::all_finite(commands)) return false;
  state.command_n = commands.thruster_n;
  state.integral = control.integral;
  state.mission.speed_n = control.speed_n;
  return true;
}

Vec3 PhysicsWorld::current_ned_m_s(const Vec3& position_ned_m, double time_s) const {
  if (!current_) return Vec3(0.0);
  return rov::ned_from_world(
      sim::sample(*current_, rov::world_from_ned(position_ned_m), time_s).velocity_m_s);
}

diver::WaterFlow PhysicsWorld::water_ned(const Vec3& position_ned_m, double time_s) const {
  diver::WaterFlow out(current_ned_m_s(position_ned_m, time_s));
  if (!waves_) return out;
  const WaveFlow flow = waves_->flow(rov::world_from_ned(position_ned_m), time_s);
  out.waves_m_s = rov::ned_from_world(flow.velocity_m_s);
  out.current_m_s += out.waves_m_s;
  out.head_m = flow.head_m;
  return out;
}

// The forces on it in the step to come.
rov::Inputs PhysicsWorld::acting_on(const PhysicsVehicle& vehicle, const VehicleInputs& inputs,
                                    const VehicleState& state, double time_s, double dt_s) const {
  rov::Inputs acting;
  acting.thruster_n = state.command_n;
  const diver::WaterFlow water =
      water_along(current_, waves_, state.body.position_ned_m,
                  state.body.attitude * state.body.velocity.linear(), time_s, dt_s);
  acting.current_ned_m_s = water.current_m_s;
  acting.current_change_ned_m_s2 = water.change_m_s2;
  acting.water_acceleration_ned_m_s2 = water.acceleration_m_s2;
  acting.tether_anchor_ned_m = vehicle.tether_anchor_ned_m;
  acting.failed_thrusters = failed_thrusters(vehicle, inputs, state);
  apply_surface(vehicle.vehicle, vehicle.kind.top_m, vehicle.kind.bottom_m, state.body,
                water.head_m, acting);
  if (layers_) {
    // The vehicle's buoyancy is that in water of the scene's density.
    const double more = layers_->density_kg_m3(state.body.position_ned_m.z) / water_kg_m3_ - 1.0;
    const Vec3 lift_n =
        glm::conjugate(state.body.attitude) * Vec3(0.0, 0.0, -more * vehicle.vehicle.buoyancy_n);
    acting.wrench =
        acting.wrench + rov::vec6(lift_n, glm::cross(vehicle.vehicle.buoyancy_centre_m, lift_n));
  }
  if (vehicle.wash) add_ground_effect(vehicle, rays(), state.body, acting);
  return acting;
}

// The added mass of a vehicle where it is, for the part of a step to come.
void PhysicsWorld::add_near_bounds(std::size_t i, const rov::State& state, double time_s,
                                   VehicleScratch& own) const {
  const PhysicsVehicle& vehicle = vehicles_[i];
  const double radius_m = vehicle.near_radius_m, reach_m = rov::kNearBounds * radius_m;
  const Vec3 at_ned_m = state.position_ned_m + state.attitude * vehicle.vehicle.buoyancy_centre_m;
  std::array<rov::WaterBound, 2> bounds{};
  std::size_t count = 0;
  const double deep_m = at_ned_m.z + water_ned(at_ned_m, time_s).head_m;
  if (deep_m < reach_m) bounds[count++] = {deep_m, Vec3(0.0, 0.0, 1.0), true};
  // The plane of the bottom under it: on a slope that is nearer than the ray is long.
  const auto bottom =
      solid_.cast(rov::world_from_ned(at_ned_m), Vec3(0.0, -1.0, 0.0), 2.0 * reach_m);
  if (bottom) {
    const Vec3 normal_ned = rov::ned_from_world(bottom->normal);
    bounds[count++] = {bottom->distance_m * -normal_ned.z, normal_ned, false};
  }
  const rov::Vec6 through_water =
      rov::through_water(state.attitude, state.velocity, own.acting.current_ned_m_s);
  own.acting.wrench =
      own.acting.wrench + rov::near_added_mass(vehicle.vehicle, radius_m,
                                               std::span(bounds).first(count), state.attitude,
                                               through_water, own.near.front());
}

Result<std::optional<rov::NavigationModel>> choose_navigation(const scene::Scene& scene,
                                                              const scene::Object& object,
                                                              const rov::SensorSet& sensors) {
  using Navigation = scene::Dynamics::Navigation;
  const Navigation wanted = object.dynamics->navigation;
  const std::string missing = rov::missing_for_navigation(sensors);
  if (wanted == Navigation::kMeasured && !missing.empty())
    return bad_input(
        "{}: {}: navigation: found \"measured\"; accepted: \"truth\", or {} added to {}",
        scene.path, object.name, missing, object.dynamics->file.string());
  std::optional<rov::NavigationModel> out;
  if (wanted != Navigation::kTruth && missing.empty()) {
    const bool named = scene.water && scene.water->column;
    out = rov::navigation_model(sensors, named);
  }
  return out;
}

void PhysicsWorld::start_navigation(std::size_t index, PhysicsState& state) const {
  const PhysicsVehicle& vehicle = vehicles_[index];
  if (!vehicle.navigation) return;
  state.navigation()[vehicle.navigation->place] =
      rov::start_navigation(vehicle.navigation->model, *readings(state, index),
                            rov::surveyed_launch(vehicle.start.position_ned_m, seed_, index), 0.0);
}

void PhysicsWorld::navigate(std::size_t index, double time_s, PhysicsState& state) const {
  const PhysicsVehicle& vehicle = vehicles_[index];
  if (vehicle.navigation)
    rov::update_navigation(vehicle.navigation->model, *readings(state, index), time_s,
                           state.navigation()[vehicle.navigation->place]);
}

const rov::NavigationState* PhysicsWorld::navigation(const PhysicsState& state,
                                                     std::size_t vehicle) const {
  const auto& at = vehicles_[vehicle].navigation;
  return at ? &state.navigation()[at->place] : nullptr;
}

std::optional<rov::NavigationEstimate> PhysicsWorld::estimate(const PhysicsState& state,
                                                              std::size_t vehicle) const {
  const rov::NavigationState* found = navigation(state, vehicle);
  if (!found) return std::nullopt;
  return rov::estimate_of(vehicles_[vehicle].navigation->model, *found);
}

rov::State PhysicsWorld::known_state(const PhysicsState& state, std::size_t vehicle,
                                     double time_s) const {
  const rov::State& body = state.vehicles()[vehicle].body;
  const rov::NavigationState* found = navigation(state, vehicle);
  if (!found) return body;
  return rov::estimated_state(vehicles_[vehicle].navigation->model, *found, time_s, body);
}

}  // namespace neritic::testbed
