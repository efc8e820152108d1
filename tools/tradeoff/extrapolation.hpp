// A reference integrator of high order: the extrapolated midpoint rule (Gragg, Bulirsch, Stoer
// 1966; Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I", II.9), step size and
// order by its own error estimate. Slow and accurate; to hold other integrators against. Pure
// function.
#pragma once

#include <functional>
#include <vector>

namespace neritic::tools {

using Vector = std::vector<double>;
// dy/dt at t.
using Slope = std::function<Vector(double t, const Vector& y)>;

struct Extrapolated {
  Vector y;
  int steps = 0, evaluations = 0;
  bool converged = true;  // false: the step had to become too small
};
// y at t1 from y at t0; tolerance a component, absolute and relative to its size.
Extrapolated extrapolate(const Slope& slope, double t0, double t1, Vector y, double tolerance);

}  // namespace neritic::tools
