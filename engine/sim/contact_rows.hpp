// The parts of the contact solver: six-vectors, the rows of one contact, and a round's steps. Body
// axes.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/sim/contact_solver.hpp"

namespace neritic::sim {

using Six = std::array<double, 6>;

inline Six six_of(const Twist& twist) {
  return {twist.linear.x,  twist.linear.y,  twist.linear.z,
          twist.angular.x, twist.angular.y, twist.angular.z};
}
inline Twist twist_of(const Six& v) {
  return {Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5])};
}
// In pairs: a round is one chain of these, and waits for each sum.
inline double dot_of(const Six& a, const Six& b) {
  return (a[0] * b[0] + a[1] * b[1]) + ((a[2] * b[2] + a[3] * b[3]) + (a[4] * b[4] + a[5] * b[5]));
}
inline void add_scaled(Six& v, const Six& by, double scale) {
  for (std::size_t i = 0; i < 6; ++i) v[i] += by[i] * scale;
}

// One direction at one point: J v is the body's speed there, and an impulse changes v by M^-1 J^T.
struct SolverRow {
  Six jacobian{}, response{};
  double mobility = 0.0;  // J M^-1 J^T
  double inertia = 0.0;   // its inverse; 0 where nothing moves

  SolverRow(const Vec3& point_m, const Vec3& direction, const InverseMass& inverse_mass);
};

struct SolverContact {
  SolverRow normal, side, other;
  Vec3 side_axis, other_axis;
  double friction = 0.0;
  double target_m_s = 0.0;
  double slip_mobility = 0.0;  // the largest over the directions across the normal
  double slip_inertia = 0.0;   // its inverse; 0 where nothing moves
  Vec3 impulse{0.0};           // along normal, side, other
  // Most friction where it is not to follow the normal impulse.
  std::optional<double> friction_bound;

  SolverContact(const BodyContact& contact, const Vec3& side_, const Vec3& other_,
                const InverseMass& inverse_mass);
};
// With the axes across the normal chosen.
SolverContact solver_contact(const BodyContact& contact, const InverseMass& inverse_mass);

// One step each: the impulse that brings the contact to its target, or as near as it may. They
// return the change of the contact's speed.
double solve_normal(SolverContact& contact, double target_m_s, Six& velocity);
double solve_friction(SolverContact& contact, Six& velocity);

// Between rounds, goes on along conjugate directions of what the rounds change: nonsmooth nonlinear
// conjugate gradients (Silcowitz, Niebuhr and Erleben 2010, algorithm 4). Bodies a thousand times
// heavier along one axis than another need tens of rounds then, not thousands.
class Conjugate {
 public:
  // Begins with contacts that have no impulses yet.
  void begin(std::size_t contacts) {
    last_.assign(contacts, Vec3(0.0));
    way_.assign(contacts, Vec3(0.0));
    size_ = 0.0;
  }
  // After a round: contacts hold what it solved.
  void advance(std::vector<SolverContact>& contacts, Six& velocity);
  void reserve(std::size_t contacts) {
    last_.reserve(contacts);
    way_.reserve(contacts);
  }

 private:
  std::vector<Vec3> last_, way_;  // where the last round began, and the direction
  double size_ = 0.0;
};

}  // namespace neritic::sim
