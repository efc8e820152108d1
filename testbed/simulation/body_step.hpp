// One step of one vehicle through the water and along what is solid: rov::step, then
// sim::move_body with the vehicle's own mass matrix, added mass included; in between what other
// vehicles do to it. Pure functions; any thread.
#pragma once

#include "engine/sim/body_pair.hpp"
#include "engine/sim/contact_memory.hpp"
#include "rov/step.hpp"

namespace neritic::testbed {

// The body for which contacts are solved. Model axes (starboard, up, back) about the vehicle's
// origin.
struct SolidBody {
  sim::BodyShape shape;
  sim::InverseMass inverse_mass{};
};
// The shape has no parts yet.
SolidBody solid_body(const rov::Vehicle& vehicle);

// How a step is taken.
struct StepMethod {
  rov::Integrator integrator = rov::Integrator::kGuarded;
  // Over 0: a step with a contact is halved until a half changes it by no more than this, m, and
  // goes on where the halves lead: second order. 0: it is one step, of first order.
  double contact_error_m = 0.0;
};

struct VehicleStep {
  const SolidBody& body;
  const rov::Vehicle& vehicle;
  const rov::State& before;
  const rov::Inputs& inputs;
  double dt_s;
  StepMethod method;
};

// The effect of contacts in a step.
struct ContactReport {
  sim::MotionReport motion;
  // Change of velocity by contacts alone: linear and angular, NED axes, m/s and rad/s.
  rov::Vec6 change_ned;
};

// Sums over the parts of a step; the number of contacts is the last part's.
void add_part(const ContactReport& part, ContactReport& whole);

// Linear and angular, NED axes.
rov::Vec6 velocity_ned(const rov::State& state);
// The step without contacts.
rov::State free_step(const VehicleStep& step);
// The vehicle as the solver of pairs takes it; and the motion that the solver returned.
sim::PairBody pair_body(const VehicleStep& step, const rov::State& free);
void set_motion(const sim::BodyMotion& motion, rov::State& state);
// Whether two vehicles touched: their free steps then part.
bool part_vehicles(const VehicleStep& a, rov::State& free_a, const VehicleStep& b,
                   rov::State& free_b, sim::PairMemory& memory);
// The step with contacts. Axes of rov and of sim differ by exchanged components alone, so a vehicle
// that touches nothing keeps every bit. parted: the step is not halved.
rov::State step_among(const sim::StaticWorld& solid, const VehicleStep& step,
                      const rov::State& free, bool parted, sim::ContactMemory& memory,
                      ContactReport* report = nullptr);
// The same with memory of its own, for single steps that nothing parted.
rov::State step_among(const sim::StaticWorld& solid, const VehicleStep& step,
                      const rov::State& free);

}  // namespace neritic::testbed
