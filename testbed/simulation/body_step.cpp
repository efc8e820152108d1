#include "testbed/simulation/body_step.hpp"

#include <algorithm>

#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

// Coulomb's, of a vehicle on another: that of a scene's things.
constexpr double kVehicleFriction = sim::Surface{}.friction;

sim::BodyMotion motion_of(const rov::State& state) {
  return {rov::world_pose(state.position_ned_m, state.attitude),
          {rov::world_from_ned(state.velocity.linear()),
           rov::world_from_ned(state.velocity.angular())}};
}

rov::State step_once(const sim::StaticWorld& solid, const SolidBody& body, const rov::State& before,
                     rov::State free, double dt_s, sim::ContactMemory& memory,
                     ContactReport& report) {
  const sim::BodyMotion moved = sim::move_body(
      solid, body.shape, body.inverse_mass, rov::world_pose(before.position_ned_m, before.attitude),
      motion_of(free), dt_s, memory, &report.motion);
  if (!report.motion.touched) return free;
  const rov::Vec6 without = velocity_ned(free);
  set_motion(moved, free);
  report.change_ned = velocity_ned(free) - without;
  return free;
}

}  // namespace

void add_part(const ContactReport& part, ContactReport& whole) {
  whole.motion.contacts = part.motion.contacts;
  whole.motion.pieces += part.motion.pieces;
  whole.motion.touched = whole.motion.touched || part.motion.touched;
  whole.motion.converged = whole.motion.converged && part.motion.converged;
  whole.motion.lost_s += part.motion.lost_s;
  whole.motion.deepest_m = std::max(whole.motion.deepest_m, part.motion.deepest_m);
  whole.motion.impulse_n_s += part.motion.impulse_n_s;
  whole.change_ned = whole.change_ned + part.change_ned;
}

SolidBody solid_body(const rov::Vehicle& vehicle) {
  return {{}, rov::world_from_ned(vehicle.inverse_mass).m};
}

rov::Vec6 velocity_ned(const rov::State& state) {
  return rov::vec6(state.attitude * state.velocity.linear(),
                   state.attitude * state.velocity.angular());
}

rov::State free_step(const VehicleStep& step) {
  return rov::step(step.vehicle, step.before, step.inputs, step.dt_s, step.method.integrator);
}

sim::PairBody pair_body(const VehicleStep& step, const rov::State& free) {
  return {step.body.shape, step.body.inverse_mass,
          rov::world_pose(step.before.position_ned_m, step.before.attitude), motion_of(free)};
}

void set_motion(const sim::BodyMotion& motion, rov::State& state) {
  state.position_ned_m = rov::ned_from_world(motion.world_from_body.position_m);
  state.attitude = rov::ned_from_world(motion.world_from_body.rotation);
  state.velocity = rov::vec6(rov::ned_from_world(motion.velocity.linear),
                             rov::ned_from_world(motion.velocity.angular));
}

bool part_vehicles(const VehicleStep& a, rov::State& free_a, const VehicleStep& b,
                   rov::State& free_b, sim::PairMemory& memory) {
  sim::PairBody pair_a = pair_body(a, free_a), pair_b = pair_body(b, free_b);
  if (!sim::part_bodies(pair_a, pair_b, kVehicleFriction, a.dt_s, memory)) return false;
  set_motion(pair_a.free, free_a);
  set_motion(pair_b.free, free_b);
  return true;
}

rov::State step_among(const sim::StaticWorld& solid, const VehicleStep& step,
                      const rov::State& free, bool parted, sim::ContactMemory& memory,
                      ContactReport* report) {
  ContactReport told;
  rov::State after = step_once(solid, step.body, step.before, free, step.dt_s, memory, told);
  if (told.motion.touched && !parted && step.method.contact_parts > 1) {
    const double part_s = step.dt_s / step.method.contact_parts;
    told = {.motion = {.touched = true, .deepest_m = told.motion.deepest_m}, .change_ned = {}};
    after = step.before;
    rov::Inputs inputs = step.inputs;
    for (int i = 0; i < step.method.contact_parts; ++i) {
      const rov::State before = after;
      ContactReport part;
      after = step_once(solid, step.body, before,
                        free_step({step.body, step.vehicle, before, inputs, part_s, step.method}),
                        part_s, memory, part);
      part.motion.deepest_m = 0.0;  // within the step
      add_part(part, told);
      inputs.current_ned_m_s += part_s * inputs.current_change_ned_m_s2;
    }
  }
  if (report) *report = told;
  return after;
}

rov::State step_among(const sim::StaticWorld& solid, const VehicleStep& step,
                      const rov::State& free) {
  sim::ContactMemory memory;
  return step_among(solid, step, free, false, memory);
}

}  // namespace neritic::testbed
