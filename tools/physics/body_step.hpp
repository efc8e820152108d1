// One step of one vehicle through the water and along what is solid: rov::step, then
// sim::move_body with the vehicle's own mass matrix, added mass included. A pure function; any
// thread.
#pragma once

#include "engine/sim/motion.hpp"
#include "rov/step.hpp"

namespace neritic::tools {

// What contacts are solved with. Model axes (starboard, up, back) about the vehicle's origin.
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

// The axes of both sides differ by exchanged components alone, so the way there and back keeps
// every bit of what is not touched.
rov::State step_among(const sim::StaticWorld& solid, const SolidBody& body,
                      const rov::Vehicle& vehicle, const rov::State& before,
                      const rov::Inputs& inputs, double dt_s, const StepMethod& method = {},
                      sim::MotionReport* report = nullptr);

}  // namespace neritic::tools
