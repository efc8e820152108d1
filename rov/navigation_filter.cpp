#include "rov/navigation_filter.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::rov {
namespace {

using Square = std::array<std::array<double, kErrors>, kErrors>;
using Column = std::array<double, kErrors>;

// Standard deviations stay below these, whatever time passes without a correction: attitude,
// velocity, position, biases.
constexpr double kMostSigma[] = {kPi, 1e3, 1e6, 1e3};

// The second-order effect of a wrong attitude on the force stays much the same for this time. As a
// white noise it is made wide enough that it adds up to as much.
constexpr double kBent_s = 1.0;
// A reading is of no shorter time than this, even if the state was carried up to its end before.
constexpr double kLeastBent_s = 1e-3;

Square full(const Covariance& p) {
  Square out;
  for (std::size_t i = 0; i < kErrors; ++i)
    for (std::size_t j = i; j < kErrors; ++j) out[i][j] = out[j][i] = p(i, j);
  return out;
}

// The symmetric part. Variances are cut to what an error can be: a row and column scaled alike
// leave the matrix positive.
void store(Square& p, Covariance& out) {
  for (std::size_t i = 0; i < kErrors; ++i) {
    const double most = kMostSigma[std::min<std::size_t>(i / 3, 3)];
    const double variance = p[i][i];
    const double scale = !(variance > 0.0)        ? 0.0
                         : variance > most * most ? most / std::sqrt(variance)
                                                  : 1.0;
    if (scale == 1.0) continue;
    for (std::size_t j = 0; j < kErrors; ++j) {
      p[i][j] *= scale;
      p[j][i] *= scale;
    }
  }
  for (std::size_t i = 0; i < kErrors; ++i)
    for (std::size_t j = i; j < kErrors; ++j) out.set(i, j, 0.5 * (p[i][j] + p[j][i]));
}

// Lower triangle of Cholesky's decomposition; false where s is not positive definite.
bool decompose(std::array<std::array<double, 3>, 3>& s, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = s[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= s[i][k] * s[j][k];
      if (i != j)
        s[i][j] = sum / s[j][j];
      else if (sum > 0.0 && std::isfinite(sum))
        s[i][i] = std::sqrt(sum);
      else
        return false;
    }
  return true;
}

// No measurement takes more than this share of a variance away at once, so that what is left stays
// well above the rounding of what was there; the next ones go on.
constexpr double kLeastLeft = 1e-10;

// A measurement's covariances with the errors, and its noise.
struct Innovation {
  std::array<Column, 3> with_errors{};           // P H^T, a column each
  std::array<std::array<double, 3>, 3> noise{};  // R
  std::array<std::array<double, 3>, 3> root{};   // Cholesky's triangle of S = H P H^T + R
  double nis = -1.0;
};

Innovation innovation_of(const NavigationState& state, const Measurement& m) {
  Innovation out;
  for (std::size_t r = 0; r < m.count; ++r)
    for (std::size_t j = 0; j < kErrors; ++j) {
      if (m.change[r][j] == 0.0) continue;
      for (std::size_t i = 0; i < kErrors; ++i)
        out.with_errors[r][i] += state.covariance(i, j) * m.change[r][j];
    }
  out.noise = m.noise;
  for (std::size_t r = 0; r < m.count; ++r)
    for (std::size_t c = 0; c < m.count; ++c) {
      double sum = 0.0;
      for (std::size_t j = 0; j < kErrors; ++j) sum += m.change[r][j] * out.with_errors[c][j];
      if (r == c) out.noise[r][r] += kLeastLeft * sum;
      out.root[r][c] = sum + out.noise[r][c];
    }
  if (!decompose(out.root, m.count)) return out;
  std::array<double, 3> white{};
  double nis = 0.0;
  for (std::size_t r = 0; r < m.count; ++r) {
    double sum = m.innovation[r];
    for (std::size_t k = 0; k < r; ++k) sum -= out.root[r][k] * white[k];
    white[r] = sum / out.root[r][r];
    nis += white[r] * white[r];
  }
  // Infinity is a number here: far beyond the bound.
  out.nis = std::isnan(nis) ? -1.0 : nis;
  return out;
}

// K = P H^T S^-1, a column a number.
std::array<Column, 3> gain_of(const Innovation& in, std::size_t n) {
  std::array<Column, 3> gain{};
  for (std::size_t i = 0; i < kErrors; ++i) {
    std::array<double, 3> y{};
    for (std::size_t r = 0; r < n; ++r) {
      double sum = in.with_errors[r][i];
      for (std::size_t k = 0; k < r; ++k) sum -= in.root[r][k] * y[k];
      y[r] = sum / in.root[r][r];
    }
    for (std::size_t r = n; r-- > 0;) {
      double sum = y[r];
      for (std::size_t k = r + 1; k < n; ++k) sum -= in.root[k][r] * gain[k][i];
      gain[r][i] = sum / in.root[r][r];
    }
  }
  return gain;
}

// Far above the rounding of kErrors sums in 53 bits, far below what any noise of a sensor adds.
constexpr double kRounding = 1e-12;

void apply(NavigationState& state, const Measurement& m, const Innovation& in) {
  const auto gain = gain_of(in, m.count);
  // A = (I - K H) P, then A (I - K H)^T + K R K^T = A - (A H^T - K R) K^T.
  Square a = full(state.covariance);
  for (std::size_t r = 0; r < m.count; ++r)
    for (std::size_t i = 0; i < kErrors; ++i) {
      const double k = gain[r][i];
      if (k == 0.0) continue;
      for (std::size_t j = 0; j < kErrors; ++j) a[i][j] -= k * in.with_errors[r][j];
    }
  std::array<Column, 3> left{};
  for (std::size_t r = 0; r < m.count; ++r)
    for (std::size_t i = 0; i < kErrors; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < kErrors; ++j) sum += a[i][j] * m.change[r][j];
      for (std::size_t c = 0; c < m.count; ++c) sum -= gain[c][i] * in.noise[c][r];
      left[r][i] = sum;
    }
  for (std::size_t r = 0; r < m.count; ++r)
    for (std::size_t i = 0; i < kErrors; ++i)
      for (std::size_t j = 0; j < kErrors; ++j) a[i][j] -= left[r][i] * gain[r][j];
  // What is subtracted is rounded by shares of the variance before: after a measurement of
  // something hardly known they are more than what is left, which could then be no covariance.
  for (std::size_t i = 0; i < kErrors; ++i) a[i][i] += kRounding * state.covariance(i, i);
  store(a, state.covariance);
  Column error{};
  for (std::size_t r = 0; r < m.count; ++r)
    for (std::size_t i = 0; i < kErrors; ++i) error[i] += gain[r][i] * m.innovation[r];
  add_error(state, error);
}

// Adds the innovation, as an error of what is measured, to the covariance.
void doubt(NavigationState& state, const Measurement& m) {
  for (std::size_t r = 0; r < m.count; ++r) {
    const double* change = &m.change[r][m.of];
    const double square = change[0] * change[0] + change[1] * change[1] + change[2] * change[2];
    if (!(square > 0.0)) continue;
    const double share = m.innovation[r] / square;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j)
        state.covariance.set(
            m.of + i, m.of + j,
            state.covariance(m.of + i, m.of + j) + share * change[i] * share * change[j]);
  }
}

}  // namespace

double second_order(const NavigationState& state, const Vec3& v_ned) {
  // |e x (e x v)|^2 = (e . e) (e . A e), A = |v|^2 I - v v^T, whose mean over normal errors of
  // covariance P is tr(P) tr(A P) + 2 tr(A P P).
  Mat3 p;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      p[j][i] = state.covariance(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  const Vec3 pv = p * v_ned;
  const double trace = p[0][0] + p[1][1] + p[2][2], square = glm::dot(v_ned, v_ned);
  double of_square = 0.0;  // tr(P P)
  for (int i = 0; i < 3; ++i) of_square += glm::dot(p[i], p[i]);
  const double mean = trace * (square * trace - glm::dot(v_ned, pv)) +
                      2.0 * (square * of_square - glm::dot(pv, pv));
  return 0.5 * std::sqrt(std::max(0.0, mean));
}

Quat rotation_by(const Vec3& angle) {
  const double half = 0.5 * glm::length(angle);
  // sin(x) / x to second order near 0, exact to rounding there.
  const double share = half < 1e-4 ? 0.5 * (1.0 - half * half / 6.0) : 0.5 * std::sin(half) / half;
  return {std::cos(half), share * angle.x, share * angle.y, share * angle.z};
}

void move(NavigationState& state, const ImuReading& mean, double gravity_m_s2, double dt_s) {
  const Vec3 turning = mean.angular_rad_s - state.bias3(kGyroBias);
  const Vec3 force = mean.specific_force_m_s2 - state.bias3(kAccelerometerBias);
  if (!(dt_s > 0.0) || !std::isfinite(dt_s)) return;
  const Quat half_way = state.attitude * rotation_by(0.5 * dt_s * turning);
  const Vec3 gained = dt_s * (half_way * force);
  const Vec3 change = gained + dt_s * Vec3(0.0, 0.0, gravity_m_s2);
  state.position_ned_m += dt_s * (state.velocity_ned_m_s + 0.5 * change);
  state.velocity_ned_m_s += change;
  state.attitude = glm::normalize(state.attitude * rotation_by(dt_s * turning));
  state.time_s += dt_s;
  state.pending_s += dt_s;
  state.pending_ned_m_s += gained;
}

void coast(NavigationState& state, double silent_s, double dt_s) {
  if (!(dt_s > 0.0) || !std::isfinite(dt_s)) return;
  // The velocity is not known to last longer than this.
  constexpr double kLongest_s = 10.0;
  state.position_ned_m += std::min(dt_s, kLongest_s) * state.velocity_ned_m_s;
  state.time_s += dt_s;
  const auto grow = [&](std::size_t i, double rate, double power) {
    const double most = kMostSigma[i / 3];
    const auto variance = [&](double s) {
      const double sigma = std::min(rate * std::pow(std::min(s, 1e3), power), most);
      return sigma * sigma;
    };
    state.covariance.set(i, i,
                         state.covariance(i, i) + variance(silent_s + dt_s) - variance(silent_s));
  };
  for (std::size_t i = 0; i < 3; ++i) {
    grow(kAttitudeError + i, i < 2 ? 0.05 : 0.5, 1.0);
    grow(kVelocityError + i, 0.5, 1.0);
    grow(kPositionError + i, 0.25, 2.0);
  }
}

Transition transition(const NavigationState& state) {
  Transition out{};
  for (std::size_t i = 0; i < kFirstBias; ++i) out[i][i] = 1.0;
  const double t = state.pending_s;
  const Mat3 ned_from_body = glm::mat3_cast(state.attitude);
  const Vec3 s = state.pending_ned_m_s;
  // [s]x, row by row.
  const double cross[3][3] = {{0.0, -s.z, s.y}, {s.z, 0.0, -s.x}, {-s.y, s.x, 0.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    out[kPositionError + i][kVelocityError + i] = t;
    for (std::size_t j = 0; j < 3; ++j) {
      const double r = ned_from_body[static_cast<int>(j)][static_cast<int>(i)];
      double cross_r = 0.0;
      for (std::size_t k = 0; k < 3; ++k)
        cross_r += cross[i][k] * ned_from_body[static_cast<int>(j)][static_cast<int>(k)];
      out[kAttitudeError + i][kGyroBias + j] = -t * r;
      out[kVelocityError + i][kAttitudeError + j] = -cross[i][j];
      out[kVelocityError + i][kAccelerometerBias + j] = -t * r;
      out[kVelocityError + i][kGyroBias + j] = t / 2.0 * cross_r;
      out[kPositionError + i][kAttitudeError + j] = -t / 2.0 * cross[i][j];
      out[kPositionError + i][kAccelerometerBias + j] = -t * t / 2.0 * r;
      out[kPositionError + i][kGyroBias + j] = t * t / 6.0 * cross_r;
    }
  }
  return out;
}

void move_covariance(NavigationState& state, const MotionNoise& noise) {
  const double t = state.pending_s;
  if (t == 0.0) return;
  const Transition f = transition(state);
  Square p = full(state.covariance);
  Square moved = p;  // F P
  for (std::size_t i = 0; i < kFirstBias; ++i)
    for (std::size_t k = 0; k < kBeamBias; ++k) {
      if (k == i || f[i][k] == 0.0) continue;
      for (std::size_t j = 0; j < kErrors; ++j) moved[i][j] += f[i][k] * p[k][j];
    }
  // F P F^T: what the biases have to do with the motion is F P already.
  p = moved;
  for (std::size_t i = 0; i < kFirstBias; ++i) {
    for (std::size_t j = 0; j < kFirstBias; ++j)
      for (std::size_t k = 0; k < kBeamBias; ++k)
        if (k != i) p[j][i] += moved[j][k] * f[i][k];
    for (std::size_t j = kFirstBias; j < kErrors; ++j) p[j][i] = moved[i][j];
  }
  const double bent_m_s = second_order(state, state.pending_ned_m_s);
  const double force =
      noise.accelerometer + bent_m_s * bent_m_s * kBent_s / (t * std::max(t, kLeastBent_s));
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t v = kVelocityError + i, x = kPositionError + i;
    p[kAttitudeError + i][kAttitudeError + i] += noise.gyro * t;
    p[v][v] += force * t;
    p[v][x] += force * t * t / 2.0;
    p[x][v] += force * t * t / 2.0;
    p[x][x] += force * t * t * t / 3.0;
  }
  for (std::size_t i = kFirstBias; i < kErrors; ++i) p[i][i] += noise.walk[i - kFirstBias] * t;
  store(p, state.covariance);
  state.pending_s = 0.0;
  state.pending_ned_m_s = Vec3(0.0);
}

double normalized_innovation_squared(const NavigationState& state, const Measurement& m) {
  return innovation_of(state, m).nis;
}

double outlier_bound(std::size_t count) {
  constexpr double kBound[] = {10.828, 13.816, 16.266};
  return kBound[count - 1];
}

bool correct(NavigationState& state, const Measurement& m, AidTally& tally,
             std::uint64_t patience) {
  for (std::size_t r = 0; r < m.count; ++r)
    if (!std::isfinite(m.innovation[r])) {
      ++tally.refused;
      return false;
    }
  Innovation in = innovation_of(state, m);
  if (in.nis < 0.0) {
    ++tally.refused;
    return false;
  }
  tally.nis = std::min(in.nis, 1e300);
  if (in.nis > outlier_bound(m.count)) {
    ++tally.rejected;
    if (++tally.rejected_in_a_row < patience) return false;
    doubt(state, m);
    in = innovation_of(state, m);
    if (in.nis < 0.0) return false;
    ++tally.readmitted;
  }
  tally.rejected_in_a_row = 0;
  ++tally.accepted;
  tally.accepted_s = state.time_s;
  apply(state, m, in);
  return true;
}

void add_error(NavigationState& state, const std::array<double, kErrors>& e) {
  const auto at = [&](std::size_t i) { return Vec3(e[i], e[i + 1], e[i + 2]); };
  state.attitude = glm::normalize(rotation_by(at(kAttitudeError)) * state.attitude);
  state.velocity_ned_m_s += at(kVelocityError);
  state.position_ned_m += at(kPositionError);
  for (std::size_t i = kFirstBias; i < kErrors; ++i) state.bias[i - kFirstBias] += e[i];
}

}  // namespace neritic::rov
