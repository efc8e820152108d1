// Contact impulses of one body against what does not move. Velocity and inverse mass are the body's
// own: six components about its origin in body axes, the mass any symmetric positive definite
// matrix, e.g. rigid body plus added mass (Fossen 2011, eq. 6.52). Pure functions; any thread.
//
//   v' = v + M^-1 J^T lambda,   0 <= lambda_n  _|_  n . v'_c >= target,   |lambda_t| <= mu lambda_n
//
// solved by projected Gauss-Seidel in the order of the contacts (Catto 2005), friction as a cone.
// The target is -gap / dt, so that a body comes to touch and no farther (speculative contacts). If
// a contact hits faster than kBounce_m_s, its target is the bounce -e n . v_c; with e = 0 only for
// a contact that touches already. So a hit is one impulse; in two, its friction would depend on
// where in the step the hit falls. Depth is undone by a velocity of its own that moves the body in
// this step only and carries no energy (split impulses).
#pragma once

#include <array>
#include <span>

#include "engine/core/math.hpp"

namespace neritic::sim {

// Linear (m/s) and angular velocity (rad/s) of the body's origin, body axes.
struct Twist {
  Vec3 linear{0.0}, angular{0.0};
};
// Rows first; three linear components, then three angular: [kg^-1 ...].
using InverseMass = std::array<double, 36>;

// More than gravity adds in a step of 240 Hz, so that a resting body does not hop.
inline constexpr double kBounce_m_s = 0.05;
// In steps that are compared with each other, what is met faster than this is a hit of its own: a
// soft hit that two steps share leads elsewhere by how they share it, however short they are.
inline constexpr double kPreciseHit_m_s = 0.01;

// In body axes about the body's origin.
struct BodyContact {
  Vec3 point_m{0.0};
  Vec3 normal{0.0};    // unit, towards the body
  double gap_m = 0.0;  // negative: depth
  double friction = 0.0, restitution = 0.0;
};

struct ContactImpulse {
  double normal_n_s = 0.0;
  Vec3 friction_n_s{0.0};  // body axes, across the normal
};

struct ContactSolution {
  Twist velocity;
  Twist push;  // out of what is penetrated: for this step's motion only
  std::span<const ContactImpulse> impulses;  // one a contact, in the solver's memory
  int rounds = 0;
  bool converged = true;

  bool acted() const {
    for (const ContactImpulse& impulse : impulses)
      if (impulse.normal_n_s > 0.0) return true;
    return push.linear != Vec3(0.0) || push.angular != Vec3(0.0);
  }
};

struct SolverMemory;  // contact_memory.hpp
// free: the velocity at the end of the step if there were no contacts. dt_s > 0. memory: any
// content; the solution's impulses lie in it.
ContactSolution solve_contacts(std::span<const BodyContact> contacts,
                               const InverseMass& inverse_mass, const Twist& free, double dt_s,
                               SolverMemory& memory);

// The time within dt_s at which the body first hits a contact that it does not touch yet, faster
// than kBounce_m_s, or precisely kPreciseHit_m_s; dt_s: none.
double time_to_hit(std::span<const BodyContact> contacts, const Twist& velocity, double dt_s,
                   bool precise = false);
// Whether one is met within dt_s so fast.
bool meets_hard(std::span<const BodyContact> contacts, const Twist& velocity, double dt_s,
                bool precise = false);

}  // namespace neritic::sim
