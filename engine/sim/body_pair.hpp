// Two moving bodies that meet, each with its own mass matrix; contacts with things that stand still
// are solved after it (motion.hpp). Pure functions; any thread.
//
//   v_a' = v_a + M_a^-1 J_a^T lambda,  v_b' = v_b - M_b^-1 J_b^T lambda,
//   0 <= lambda_n  _|_  n . (v_a,c' - v_b,c') >= -gap / dt,   |lambda_t| <= mu lambda_n
//
// by projected Gauss-Seidel (Catto 2005), at the nearest points of each pair of parts; a hit does
// not bounce. Depth is undone by a velocity that moves both in this step only. To first order in
// the step's way: bodies that move by many times their size in one step may pass each other.
#pragma once

#include "engine/sim/motion.hpp"
#include "engine/sim/pair_solver.hpp"

namespace neritic::sim {

struct PairBody {
  const BodyShape& shape;
  const InverseMass& inverse_mass;
  Pose before;
  BodyMotion free;  // its step as if alone; changed where the other is in the way
};

// Two bodies whose origins before the step are farther apart than the sum of their reaches do not
// touch in it.
double pair_reach_m(const PairBody& body);
// Whether they touched; where not, both keep their bits. friction: Coulomb's coefficient.
bool part_bodies(PairBody& a, PairBody& b, double friction, double dt_s, PairMemory& memory);

}  // namespace neritic::sim
