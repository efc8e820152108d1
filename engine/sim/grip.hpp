// A thing that a body holds: a point mass at a place of it, which moves as that place does. The
// impulse that makes both velocities one is equal and opposite, so that grabbing keeps their
// momentum. Pure functions; any thread.
//
//   K J = u - (v + w x r),   K = 1/m + [1, -[r]x] M^-1 [1, -[r]x]^T
//
// with r the place, M the body's mass matrix (added mass included), v and w its velocity, u the
// point's. The body then moves by M^-1 [J; r x J], the point by -J / m.
#pragma once

#include "engine/sim/motion.hpp"

namespace neritic::sim {

struct Held {
  Vec3 at_m{0.0};          // on the body, body axes
  Vec3 velocity_m_s{0.0};  // of the point mass, world axes
  double mass_kg = 1.0;    // with the water that moves along
};

// The impulse on the body, world axes. Precondition: mass_kg > 0; the inverse mass is that of a
// body, so that K can be inverted.
Vec3 grip_impulse(const InverseMass& inverse_mass, const BodyMotion& body, const Held& held);
// Both after that impulse; the body's place follows the mean of its velocities over dt_s.
void hold(const InverseMass& inverse_mass, const Vec3& impulse_n_s, double dt_s, BodyMotion& body,
          Held& held);
// The change of the body's velocity by an impulse at a place of it, both in body axes.
Twist given_by(const InverseMass& inverse_mass, const Vec3& at_m, const Vec3& impulse_n_s);
// The velocity of a place of the body, world axes.
Vec3 point_velocity(const BodyMotion& body, const Vec3& at_m);

}  // namespace neritic::sim
