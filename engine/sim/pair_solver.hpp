// The parts of body_pair.cpp: the rows of two bodies that meet, the rounds that solve them, and the
// memory for both, which is kept from call to call. One thread at a time.
#pragma once

#include <vector>

#include "engine/sim/contact_rows.hpp"

namespace neritic::sim {

struct PairPoint {
  Vec3 point_m, normal;  // world, the point about a's origin; the normal from b to a
  double gap_m;
};

// One direction at one point of both bodies, each in its own axes.
struct PairRow {
  SolverRow a, b;
  double impulse = 0.0;

  double mobility() const { return a.mobility + b.mobility; }
  double speed(const Six& va, const Six& vb) const {
    return dot_of(a.jacobian, va) + dot_of(b.jacobian, vb);
  }
  void push(double change, Six& va, Six& vb) {
    impulse += change;
    add_scaled(va, a.response, change);
    add_scaled(vb, b.response, change);
  }
};

// The bodies' pair of velocities that keeps what the rows ask for.
struct PairSolver {
  std::vector<PairRow> normals, sides, others;
  std::vector<double> targets_m_s;

  void clear();
  // Whether anything pushed.
  bool solve(double friction, Six& va, Six& vb);

 private:
  void rub(std::size_t i, double friction, Six& va, Six& vb);
};

struct PairMemory {
  std::vector<PairPoint> points;
  PairSolver meeting, leaving;
};

}  // namespace neritic::sim
