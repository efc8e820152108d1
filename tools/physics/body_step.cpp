#include "tools/physics/body_step.hpp"

#include "rov/frames.hpp"

namespace neritic::tools {
namespace {

sim::Twist twist_of(const rov::Vec6& velocity) {
  return {rov::world_from_ned(velocity.linear()), rov::world_from_ned(velocity.angular())};
}

rov::State step_once(const sim::StaticWorld& solid, const SolidBody& body,
                     const rov::Vehicle& vehicle, const rov::State& before,
                     const rov::Inputs& inputs, double dt_s, rov::Integrator integrator,
                     sim::MotionReport& report) {
  rov::State after = rov::step(vehicle, before, inputs, dt_s, integrator);
  const sim::BodyMotion moved = sim::move_body(
      solid, body.shape, body.inverse_mass, rov::world_pose(before.position_ned_m, before.attitude),
      {rov::world_pose(after.position_ned_m, after.attitude), twist_of(after.velocity)}, dt_s,
      &report);
  after.position_ned_m = rov::ned_from_world(moved.world_from_body.position_m);
  after.attitude = rov::ned_from_world(moved.world_from_body.rotation);
  after.velocity = rov::vec6(rov::ned_from_world(moved.velocity.linear),
                             rov::ned_from_world(moved.velocity.angular));
  return after;
}

// As one step's: the depth is that at its start.
void add_part(const sim::MotionReport& part, sim::MotionReport& whole) {
  whole.contacts = part.contacts;
  whole.pieces += part.pieces;
  whole.converged = whole.converged && part.converged;
  whole.lost_s += part.lost_s;
  whole.impulse_n_s += part.impulse_n_s;
}

}  // namespace

SolidBody solid_body(const rov::Vehicle& vehicle) {
  return {{}, rov::world_from_ned(vehicle.inverse_mass).m};
}

rov::State step_among(const sim::StaticWorld& solid, const SolidBody& body,
                      const rov::Vehicle& vehicle, const rov::State& before,
                      const rov::Inputs& inputs, double dt_s, const StepMethod& method,
                      sim::MotionReport* report) {
  sim::MotionReport told;
  rov::State after = step_once(solid, body, vehicle, before, inputs, dt_s, method.integrator, told);
  if (told.touched && method.contact_parts > 1) {
    const double depth_m = told.deepest_m;
    told = {.pieces = 0, .touched = true, .deepest_m = depth_m};
    after = before;
    for (int i = 0; i < method.contact_parts; ++i) {
      sim::MotionReport part;
      after = step_once(solid, body, vehicle, after, inputs, dt_s / method.contact_parts,
                        method.integrator, part);
      add_part(part, told);
    }
  }
  if (report) *report = told;
  return after;
}

}  // namespace neritic::tools
