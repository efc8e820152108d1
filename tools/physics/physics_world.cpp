#include "tools/physics/physics_world.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "engine/scene/animation.hpp"
#include "rov/frames.hpp"
#include "rov/step_choice.hpp"
#include "tools/physics/static_scene.hpp"
#include "tools/physics/surface.hpp"

namespace neritic::tools {
namespace {

// A vehicle that starts deeper than this in something solid is a mistake of the scene's.
constexpr double kMostStartDepth_m = 0.02;

// The box about what is drawn of an object at rest, in model axes.
Status give_shape(const scene::Scene& scene, const scene::Object& object, PhysicsVehicle& vehicle) {
  const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
  const scene::Bounds bounds = scene::model_bounds(model, scene::evaluate_pose(model, -1, 0.0));
  const Vec3 low = object.scale * bounds.min, high = object.scale * bounds.max;
  const Vec3 half = 0.5 * (high - low);
  if (bounds.empty() || !(half.x > 0.0 && half.y > 0.0 && half.z > 0.0) || !is_finite(half))
    return bad_input("{}: {}: what is drawn of it has no volume; accepted: a solid vehicle",
                     scene.path, object.name);
  vehicle.shape.add_box({0.5 * (low + high), Quat(1.0, 0.0, 0.0, 0.0)}, half);
  vehicle.top_m = high.y;
  vehicle.bottom_m = low.y;
  return {};
}

Status check_thrusters(const scene::Scene& scene, const scene::Object& object,
                       const rov::Vehicle& vehicle) {
  const std::uint64_t failed = object.dynamics->failed_thrusters;
  if ((failed >> vehicle.thruster_count) == 0) return {};
  return bad_input("{}: {}: failed_thrusters: thruster {} found; accepted: 1 to {}, as {} has",
                   scene.path, object.name, std::bit_width(failed), vehicle.thruster_count,
                   object.dynamics->file.string());
}

Status check_anchor(const scene::Scene& scene, const scene::Object& object, bool tethered) {
  if (tethered == object.dynamics->tether_anchor_m.has_value()) return {};
  if (tethered)
    return bad_input(
        "{}: {}: tether_anchor_m: nothing found; accepted: [x, y, z], since {} has a "
        "tether",
        scene.path, object.name, object.dynamics->file.string());
  return bad_input("{}: {}: tether_anchor_m found; accepted: no such key, since {} has no tether",
                   scene.path, object.name, object.dynamics->file.string());
}

std::string name_of_label(const scene::Scene& scene, std::uint32_t label) {
  for (const scene::Object& object : scene.objects)
    if (label >= object.instance && label < object.instance + object.instance_count())
      return object.name;
  return "something";
}

// Of the pilot's wrench the share for which the thrusters have room beside what holds the vehicle
// level: at full thrust they would have none left, and it would overturn.
rov::Vec6 with_room(const rov::Vehicle& vehicle, const rov::Allocator& allocator,
                    const rov::Vec6& holding, const rov::Vec6& pilot) {
  const auto held_n = allocator.allocate(holding).wanted_n;
  const auto pilot_n = allocator.allocate(pilot).wanted_n;
  double share = 1.0;
  for (std::size_t i = 0; i < vehicle.thruster_count; ++i) {
    if (pilot_n[i] == 0.0) continue;
    const double limit_n =
        pilot_n[i] > 0.0 ? vehicle.thrusters[i].max_n : vehicle.thrusters[i].min_n;
    share = std::min(share, (limit_n - held_n[i]) / pilot_n[i]);
  }
  return std::max(0.0, share) * pilot;
}

sim::Twist twist_of(const rov::Vec6& velocity) {
  return {rov::world_from_ned(velocity.linear()), rov::world_from_ned(velocity.angular())};
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
    if (object.dynamics) return true;
  return false;
}

Result<std::unique_ptr<const PhysicsWorld>> PhysicsWorld::create(const scene::Scene& scene) {
  std::unique_ptr<PhysicsWorld> world(new PhysicsWorld);
  world->seed_ = scene.seed;
  NERITIC_TRY_STATUS(world->choose_step(scene));
  if (scene.current) {
    NERITIC_TRY(world->current_, current_of(*scene.current));
  }
  NERITIC_TRY(world->solid_, static_world_of(scene));
  std::vector<int> vehicle_of_object(scene.objects.size(), -1);
  int vehicles = 0;
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (scene.objects[i].dynamics) vehicle_of_object[i] = vehicles++;
  if (vehicles > static_cast<int>(kMaxVehicles))
    return bad_input("{}: {} vehicles with dynamics; accepted: at most {}", scene.path, vehicles,
                     kMaxVehicles);
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (scene.objects[i].dynamics)
      NERITIC_TRY_STATUS(world->add_vehicle(scene, i, vehicle_of_object));
  return std::unique_ptr<const PhysicsWorld>(std::move(world));
}

Status PhysicsWorld::choose_step(const scene::Scene& scene) {
  const scene::Physics& physics = *scene.physics;
  if (physics.max_error_m == 0.0) {
    step_s_ = 1.0 / physics.rate_hz;
    NERITIC_TRY(integrator_, rov::integrator_of(physics.integrator));
    return {};
  }
  const auto rate = rov::cheapest_rate(physics.max_error_m);
  if (!rate.ok()) return bad_input("{}: physics.{}", scene.path, rate.error().message);
  step_s_ = 1.0 / rate->hz;
  integrator_ = rov::Integrator::kGuarded;
  return {};
}

Status PhysicsWorld::add_vehicle(const scene::Scene& scene, std::size_t index,
                                 const std::vector<int>& vehicle_of_object) {
  const scene::Object& object = scene.objects[index];
  const scene::Dynamics& dynamics = *object.dynamics;
  NERITIC_TRY(rov::VehicleFile file, rov::read_vehicle(dynamics.file, scene.physics->water_kg_m3));
  NERITIC_TRY(const rov::Vehicle vehicle, rov::make_vehicle(file.parameters));
  NERITIC_TRY_STATUS(check_thrusters(scene, object, vehicle));
  NERITIC_TRY_STATUS(check_anchor(scene, object, vehicle.tether.has_value()));
  PhysicsVehicle out{.name = object.name,
                     .object = index,
                     .file = std::move(file),
                     .vehicle = vehicle,
                     .failed_thrusters = dynamics.failed_thrusters,
                     .allocator = rov::Allocator(vehicle, dynamics.failed_thrusters)};
  // A controller cannot act more often than the physics step.
  out.file.gains.period_s = std::max(out.file.gains.period_s, step_s_);
  if (dynamics.mission) out.mission.emplace(scene, *dynamics.mission, vehicle_of_object);
  if (dynamics.tether_anchor_m)
    out.tether_anchor_ned_m = rov::ned_from_world(*dynamics.tether_anchor_m);
  NERITIC_TRY_STATUS(give_shape(scene, object, out));
  out.inverse_mass = rov::world_from_ned(vehicle.inverse_mass).m;
  const Pose at = scene.world_from(object.mount, 0.0);
  rov::teleport(out.start, rov::ned_from_world(at.position_m), rov::ned_from_world(at.rotation));
  NERITIC_TRY_STATUS(check_start(scene, out));
  vehicles_.push_back(std::move(out));
  return {};
}

Status PhysicsWorld::check_start(const scene::Scene& scene, const PhysicsVehicle& vehicle) const {
  std::vector<sim::Contact> contacts;
  solid_.contacts(vehicle.shape,
                  rov::world_pose(vehicle.start.position_ned_m, vehicle.start.attitude), 0.0,
                  contacts);
  for (const sim::Contact& contact : contacts)
    if (contact.inside || contact.gap_m < -kMostStartDepth_m)
      return bad_input("{}: {}: starts {:.2f} m deep in {}; accepted: a place in the water",
                       scene.path, vehicle.name, -contact.gap_m,
                       name_of_label(scene, contact.surface.label));
  return {};
}

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
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    state.vehicles[i].body = vehicles_[i].start;
    state.vehicles[i].mission = mission_start(vehicles_[i].start);
  }
  return state;
}

PhysicsInputs PhysicsWorld::start_inputs() const {
  PhysicsInputs inputs;
  for (std::size_t i = 0; i < vehicles_.size(); ++i)
    inputs.vehicles[i].failed_thrusters = vehicles_[i].failed_thrusters;
  return inputs;
}

void PhysicsWorld::apply(PhysicsInputs& inputs, const PhysicsMessage& message) {
  if (message.vehicle < kMaxVehicles) inputs.vehicles[message.vehicle] = message.inputs;
}

Vec3 PhysicsWorld::current_ned_m_s(const Vec3& position_ned_m, double time_s) const {
  if (!current_) return Vec3(0.0);
  return rov::ned_from_world(
      sim::sample(*current_, rov::world_from_ned(position_ned_m), time_s).velocity_m_s);
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
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (control_due(i, state.step)) steer(i, state, inputs.vehicles[i], time_s, next.vehicles[i]);
    move(vehicles_[i], inputs.vehicles[i], time_s, dt_s, next.vehicles[i]);
  }
  return next;
}

// New commands for the thrusters.
void PhysicsWorld::steer(std::size_t index, const PhysicsState& all, const VehicleInputs& inputs,
                         double time_s, VehicleState& state) const {
  const PhysicsVehicle& vehicle = vehicles_[index];
  const bool piloted = inputs.piloted != 0;
  if (!piloted && !vehicle.mission) {
    state.command_n = {};
    return;
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
        piloted ? holding + with_room(vehicle.vehicle, allocator, holding, inputs.pilot) : holding;
    commands.thruster_n = allocator.allocate(wrench, vehicle.file.gains.saturation).force_n;
  };
  if (inputs.failed_thrusters == vehicle.failed_thrusters)
    allocate(vehicle.allocator);
  else
    allocate(rov::Allocator(vehicle.vehicle, inputs.failed_thrusters));
  rov::drive(vehicle.file, commands);
  state.command_n = commands.thruster_n;
  state.integral = control.integral;
}

// One step through the water and along what is solid.
void PhysicsWorld::move(const PhysicsVehicle& vehicle, const VehicleInputs& inputs, double time_s,
                        double dt_s, VehicleState& state) const {
  const rov::State before = state.body;
  rov::Inputs acting;
  acting.thruster_n = state.command_n;
  acting.current_ned_m_s = current_ned_m_s(before.position_ned_m, time_s);
  acting.tether_anchor_ned_m = vehicle.tether_anchor_ned_m;
  acting.failed_thrusters = inputs.failed_thrusters;
  apply_surface(vehicle.vehicle, vehicle.top_m, vehicle.bottom_m, before, acting);
  rov::State& after = state.body;
  after = rov::step(vehicle.vehicle, before, acting, dt_s, integrator_);

  // The axes of both sides differ by exchanged components alone, so the way there and back keeps
  // every bit of what is not touched.
  sim::MotionReport report;
  const sim::BodyMotion moved = sim::move_body(
      solid_, vehicle.shape, vehicle.inverse_mass,
      rov::world_pose(before.position_ned_m, before.attitude),
      {rov::world_pose(after.position_ned_m, after.attitude), twist_of(after.velocity)}, dt_s,
      &report);
  after.position_ned_m = rov::ned_from_world(moved.world_from_body.position_m);
  after.attitude = rov::ned_from_world(moved.world_from_body.rotation);
  after.velocity = rov::vec6(rov::ned_from_world(moved.velocity.linear),
                             rov::ned_from_world(moved.velocity.angular));
  state.contact.near_points = static_cast<std::uint64_t>(report.contacts);
  state.contact.touched_steps += report.touched ? 1 : 0;
  state.contact.deepest_m = std::max(state.contact.deepest_m, report.deepest_m);
  state.contact.impulse_n_s = report.impulse_n_s;
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

}  // namespace neritic::tools
