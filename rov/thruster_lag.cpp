#include "rov/thruster_lag.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"

namespace neritic::rov {
namespace {

using Matrix3 = std::array<double, 9>;

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 3; ++j) out[3 * i + j] += a[3 * i + k] * b[3 * k + j];
  return out;
}

// The companion matrix in the scaled state of LagState.
Matrix3 companion(const PreparedLag& lag) {
  const double r = lag.root;
  return {0.0, r, 0.0, 0.0, 0.0, r, -r, -lag.a1 / r, -lag.a2};
}

// exp(a) by Taylor's series after scaling and squaring (Moler, Van Loan 2003, method 3). The series
// stops at degree 12, whose remainder at norm 0.5 is below 1e-13 of the result.
Matrix3 exponential(Matrix3 a) {
  double norm = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    norm = std::max(norm, std::abs(a[3 * i]) + std::abs(a[3 * i + 1]) + std::abs(a[3 * i + 2]));
  int halvings = 0;
  for (; norm > 0.5 && halvings < 60; norm *= 0.5) ++halvings;
  for (double& x : a) x = std::ldexp(x, -halvings);
  Matrix3 sum{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  const Matrix3 one = sum;
  for (int degree = 12; degree >= 1; --degree) {  // Horner
    sum = product(a, sum);
    for (std::size_t i = 0; i < 9; ++i) sum[i] = sum[i] / degree + one[i];
  }
  for (; halvings > 0; --halvings) sum = product(sum, sum);
  return sum;
}

double fastest_rate(const ThrusterLag& lag) {
  switch (lag.kind) {
    case ThrusterLag::Kind::kNone:
      break;
    case ThrusterLag::Kind::kFirstOrder:
      return 1.0 / lag.time_s;
    case ThrusterLag::Kind::kThirdOrder:  // Fujiwara's bound of a polynomial's roots
      return 2.0 * std::max({lag.a2, std::sqrt(lag.a1), std::cbrt(lag.a0 / 2.0)});
  }
  return 0.0;
}

}  // namespace

PreparedLag::PreparedLag(const ThrusterLag& lag)
    : ThrusterLag(lag), root(std::cbrt(lag.a0)), fastest(fastest_rate(lag)) {}

Status check_lag(const ThrusterLag& lag) {
  if (lag.kind == ThrusterLag::Kind::kFirstOrder && !(lag.time_s >= 1e-6 && lag.time_s <= 1e6))
    return refusal("thruster lag", fmt::format("time {} s", lag.time_s), "[1e-6, 1e6]");
  if (lag.kind != ThrusterLag::Kind::kThirdOrder) return {};
  const bool finite = std::isfinite(lag.a0 + lag.a1 + lag.a2 + lag.b1);
  if (!finite || !(lag.a0 > 0.0) || !(lag.a2 > 0.0) || !(lag.a1 * lag.a2 > lag.a0))
    return refusal("thruster lag", fmt::format("s^3 + {} s^2 + {} s + {}", lag.a2, lag.a1, lag.a0),
                   "a denominator with stable poles");
  if (fastest_rate(lag) > 1e6)
    return refusal("thruster lag", fmt::format("poles up to {} 1/s", fastest_rate(lag)),
                   "up to 1e6");
  return {};
}

double force_of(const PreparedLag& lag, const LagState& state, double command_n) {
  switch (lag.kind) {
    case ThrusterLag::Kind::kNone:
      break;
    case ThrusterLag::Kind::kFirstOrder:
      return state[0];
    case ThrusterLag::Kind::kThirdOrder:  // b0 z1 + b1 z1', b0 = a0
      return state[0] + lag.b1 * lag.root / lag.a0 * state[1];
  }
  return command_n;
}

LagState lag_rate(const PreparedLag& lag, const LagState& state, double command_n) {
  switch (lag.kind) {
    case ThrusterLag::Kind::kNone:
      break;
    case ThrusterLag::Kind::kFirstOrder:
      return {(command_n - state[0]) / lag.time_s, 0.0, 0.0};
    case ThrusterLag::Kind::kThirdOrder: {
      const double r = lag.root;
      return {r * state[1], r * state[2],
              r * (command_n - state[0]) - lag.a1 / r * state[1] - lag.a2 * state[2]};
    }
  }
  return {};
}

double impulse_of(const PreparedLag& lag, const LagState& before, const LagState& after,
                  double command_n, double h_s) {
  double impulse = command_n * h_s;
  if (lag.kind == ThrusterLag::Kind::kFirstOrder) impulse -= lag.time_s * (after[0] - before[0]);
  if (lag.kind == ThrusterLag::Kind::kThirdOrder) {
    // lag_rate() integrated: r times the integrals of the second and third state are the changes of
    // the first and second.
    const double r = lag.root;
    const double d0 = after[0] - before[0], d1 = after[1] - before[1], d2 = after[2] - before[2];
    impulse -= (d2 + lag.a1 / (r * r) * d0 + lag.a2 / r * d1) / r;
    impulse += lag.b1 / lag.a0 * d0;
  }
  return impulse;
}

LagState settled(const ThrusterLag& lag, double command_n) {
  return {lag.kind == ThrusterLag::Kind::kNone ? 0.0 : command_n, 0.0, 0.0};
}

LagPropagator::LagPropagator(const PreparedLag& lag, double h_s) : kind_(lag.kind), h_s_(h_s) {
  if (lag.kind == ThrusterLag::Kind::kFirstOrder) decay_ = std::exp(-h_s / lag.time_s);
  if (lag.kind != ThrusterLag::Kind::kThirdOrder) return;
  p_ = companion(lag);
  for (double& x : p_) x *= h_s;
  p_ = exponential(p_);
}

LagState LagPropagator::advance(const LagState& state, double command_n) const {
  const double off = state[0] - command_n;
  switch (kind_) {
    case ThrusterLag::Kind::kNone:
      break;
    case ThrusterLag::Kind::kFirstOrder:
      return {command_n + decay_ * off, 0.0, 0.0};
    case ThrusterLag::Kind::kThirdOrder: {
      const auto row = [&](std::size_t i) {
        return p_[3 * i] * off + p_[3 * i + 1] * state[1] + p_[3 * i + 2] * state[2];
      };
      return {command_n + row(0), row(1), row(2)};
    }
  }
  return {};
}

}  // namespace neritic::rov
