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
// Without parts.
SolidBody solid_body(const rov::Vehicle& vehicle);

// How a step is taken.
struct StepMethod {
  rov::Integrator integrator = rov::Integrator::kGuarded;
  // A step in which something is touched is taken in so many parts: contacts are of first order in
  // its length. 1: in one, as any other.
  int contact_parts = 1;
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
  // Change of velocity that nothing else made: linear and angular, NED axes, m/s and rad/s.
  rov::Vec6 change_ned;
};

// Sums over the parts of a step; the number of contacts is the last part's.
void add_part(const ContactReport& part, ContactReport& whole);

// Linear and angular, NED axes.
rov::Vec6 velocity_ned(const rov::State& state);
// As if the water were empty.
rov::State free_step(const VehicleStep& step);
// For what else it meets; and what that made of it.
sim::PairBody pair_body(const VehicleStep& step, const rov::State& free);
void set_motion(const sim::BodyMotion& motion, rov::State& state);
// Whether two vehicles touched: their free steps then part.
bool part_vehicles(const VehicleStep& a, rov::State& free_a, const VehicleStep& b,
                   rov::State& free_b, sim::PairMemory& memory);
// Along what is solid. The axes of both sides differ by exchanged components alone, so the way
// there and back keeps every bit of what is not touched. parted: it is not taken in parts.
rov::State step_among(const sim::StaticWorld& solid, const VehicleStep& step,
                      const rov::State& free, bool parted, sim::ContactMemory& memory,
                      ContactReport* report = nullptr);
// The same with memory of its own, for single steps that nothing parted.
rov::State step_among(const sim::StaticWorld& solid, const VehicleStep& step,
                      const rov::State& free);

}  // namespace neritic::testbed
