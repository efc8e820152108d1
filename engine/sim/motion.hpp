// A body's motion when things are in its way. The vehicle steps without contacts; then move_body()
// takes the pose before and the motion after that step, and returns the motion with contacts: the
// same bits if nothing was touched. A body passes through nothing, whatever its speed and the step.
// Pure functions; any thread.
//
//   const rov::State free = rov::step(...);
//   const BodyMotion after = move_body(world, shape, inverse_mass, before, free_motion, dt_s);
#pragma once

#include "engine/sim/contact_solver.hpp"
#include "engine/sim/static_world.hpp"

namespace neritic::sim {

struct BodyMotion {
  Pose world_from_body;
  Twist velocity;  // body axes
};

struct MotionReport {
  int contacts = 0;  // near, in the last part of the step
  int pieces = 0;    // parts the step was cut into; 1: none of it was at risk
  int hits = 0;      // what was met faster than kSoft_m_s, each by the speed of the step's end
  bool touched = false;
  bool converged = true;   // all contact impulses
  double lost_s = 0.0;     // time that did not pass, since the step fell into too many parts
  double deepest_m = 0.0;  // penetration at the start
  bool lies = false;       // something was there at the start, near enough to press
  Vec3 impulse_n_s{0.0};   // of all contacts on the body, world axes
};

// Farther, nothing lies.
inline constexpr double kLies_m = 1e-5;
// Slower, a contact is one that lies already, or as good as that.
inline constexpr double kSoft_m_s = 1e-3;

// started: the velocity at the step's start, in the body axes there; without it only what was met
// faster than kBounce_m_s counts as a hit.
BodyMotion move_body(const StaticWorld& world, const BodyShape& shape,
                     const InverseMass& inverse_mass, const Pose& before, const BodyMotion& free,
                     double dt_s, ContactMemory& memory, MotionReport* report = nullptr,
                     const Twist* started = nullptr);
// The same with memory of its own, for single steps.
BodyMotion move_body(const StaticWorld& world, const BodyShape& shape,
                     const InverseMass& inverse_mass, const Pose& before, const BodyMotion& free,
                     double dt_s, MotionReport* report = nullptr);

// The pose after so long at this velocity: position along the world's direction of now, attitude
// about the world's axis of now.
Pose moved(const Pose& world_from_body, const Twist& velocity, double duration_s);

}  // namespace neritic::sim
