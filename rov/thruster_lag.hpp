// How thrust follows its command: at once, by a first-order lag, or by a third-order transfer
// function. All are linear, so a step of any length is exact. Pure functions; any thread.
#pragma once

#include <array>

#include "engine/core/result.hpp"

namespace neritic::rov {

struct ThrusterLag {
  enum class Kind { kNone, kFirstOrder, kThirdOrder };
  Kind kind = Kind::kNone;
  double time_s = 0.1;  // T of a first-order lag: F' = (F_command - F) / T
  // F = (b1 s + b0) / (s^3 + a2 s^2 + a1 s + a0) F_command with b0 = a0, so that it settles on
  // its command. Default: von Benzon et al. 2022 (JMSE 10(12):1898), 63 % in 20 ms.
  double a2 = 89.0, a1 = 9258.0, a0 = 108700.0, b1 = 6136.0;
};

// A thruster's memory, in newtons: [F, -, -] of a first-order lag; of a third-order one a0 times
// the canonical state z1, z1' / r, z1'' / r^2 with r = cbrt(a0), so that all three are of one size.
using LagState = std::array<double, 3>;

// With what its formulas need computed once.
struct PreparedLag : ThrusterLag {
  double root = 0.0;     // r = cbrt(a0)
  double fastest = 0.0;  // the fastest pole's rate, an upper bound, 1/s; 0 without lag

  PreparedLag() : PreparedLag(ThrusterLag{}) {}
  PreparedLag(const ThrusterLag& lag);
};

// Errors: times that are not positive, poles that are not stable (Routh-Hurwitz).
Status check_lag(const ThrusterLag& lag);

// The force that the thruster gives.
double force_of(const PreparedLag& lag, const LagState& state, double command_n);
// d state / dt.
LagState lag_rate(const PreparedLag& lag, const LagState& state, double command_n);
// The integral of the force, N s, over a time h at constant command in which the state went from
// before to after: exact, since the state's own equation gives it from the differences.
double impulse_of(const PreparedLag& lag, const LagState& before, const LagState& after,
                  double command_n, double h_s);
// The state in which a constant command has settled.
LagState settled(const ThrusterLag& lag, double command_n);

// The exact map over a time h at constant command: state(h) = settled + P (state(0) - settled).
class LagPropagator {
 public:
  LagPropagator() = default;
  LagPropagator(const PreparedLag& lag, double h_s);
  LagState advance(const LagState& state, double command_n) const;
  double h_s() const { return h_s_; }

 private:
  ThrusterLag::Kind kind_ = ThrusterLag::Kind::kNone;
  double h_s_ = 0.0;
  double decay_ = 0.0;         // of a first-order lag
  std::array<double, 9> p_{};  // of a third-order one, rows first
};

}  // namespace neritic::rov
