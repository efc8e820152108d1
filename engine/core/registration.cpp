#include "engine/core/registration.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/core/refusal.hpp"

namespace neritic {
namespace {

constexpr double kLeastSpread_m = 0.05;

struct Centred {
  Vec3 from_mean{0.0}, to_mean{0.0};
  std::vector<PointPair> pairs;  // less the means
};

Centred centred(std::span<const PointPair> pairs, double mirror) {
  Centred out{.pairs = {pairs.begin(), pairs.end()}};
  const auto n = static_cast<double>(pairs.size());
  for (PointPair& pair : out.pairs) {
    pair.from_m.x *= mirror;
    out.from_mean += pair.from_m / n;
    out.to_mean += pair.to_m / n;
  }
  for (PointPair& pair : out.pairs) {
    pair.from_m -= out.from_mean;
    pair.to_m -= out.to_mean;
  }
  return out;
}

// Eigenvalues and unit eigenvectors of a symmetric matrix, by Jacobi's rotations; the largest
// first.
template <std::size_t N>
struct Eigen {
  std::array<double, N> values{};
  std::array<std::array<double, N>, N> vectors{};  // [i]: of values[i]
};
template <std::size_t N>
Eigen<N> eigen_of(std::array<std::array<double, N>, N> a) {
  std::array<std::array<double, N>, N> v{};
  for (std::size_t i = 0; i < N; ++i) v[i][i] = 1.0;
  for (int sweep = 0; sweep < 60; ++sweep) {
    double off = 0.0, all = 0.0;
    for (std::size_t p = 0; p < N; ++p)
      for (std::size_t q = 0; q < N; ++q) (p == q ? all : off) += a[p][q] * a[p][q];
    if (off <= 1e-30 * all) break;
    for (std::size_t p = 0; p < N; ++p)
      for (std::size_t q = p + 1; q < N; ++q) {
        if (a[p][q] == 0.0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
        const double t = (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
        for (std::size_t k = 0; k < N; ++k) {
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq;
          a[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < N; ++k) {
          const double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
          const double vp = v[p][k], vq = v[q][k];
          v[p][k] = c * vp - s * vq;
          v[q][k] = s * vp + c * vq;
        }
      }
  }
  std::array<std::size_t, N> order{};
  for (std::size_t i = 0; i < N; ++i) order[i] = i;
  std::ranges::sort(order, [&](std::size_t i, std::size_t j) { return a[i][i] > a[j][j]; });
  Eigen<N> out;
  for (std::size_t i = 0; i < N; ++i) {
    out.values[i] = a[order[i]][order[i]];
    out.vectors[i] = v[order[i]];
  }
  return out;
}

Quat level_turn(const Centred& points) {
  double cosine = 0.0, sine = 0.0;
  for (const auto& [a, b] : points.pairs) {
    cosine += a.x * b.x + a.z * b.z;
    sine += a.z * b.x - a.x * b.z;
  }
  return glm::angleAxis(std::atan2(sine, cosine), Vec3(0.0, 1.0, 0.0));
}

// Horn (1987), "Closed-form solution of absolute orientation using unit quaternions", J. Opt. Soc.
// Am. A 4(4), 629: the eigenvector of the largest eigenvalue.
Quat free_turn(const Centred& points) {
  Mat3 s(0.0);  // s[column][row]: the sum of from[row] to[column]
  for (const auto& [a, b] : points.pairs) s += glm::outerProduct(a, b);
  const auto m = [&](int row, int column) { return s[column][row]; };
  const auto eigen = eigen_of<4>(
      {{{m(0, 0) + m(1, 1) + m(2, 2), m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0)},
        {m(1, 2) - m(2, 1), m(0, 0) - m(1, 1) - m(2, 2), m(0, 1) + m(1, 0), m(2, 0) + m(0, 2)},
        {m(2, 0) - m(0, 2), m(0, 1) + m(1, 0), m(1, 1) - m(0, 0) - m(2, 2), m(1, 2) + m(2, 1)},
        {m(0, 1) - m(1, 0), m(2, 0) + m(0, 2), m(1, 2) + m(2, 1), m(2, 2) - m(0, 0) - m(1, 1)}}});
  const auto& q = eigen.vectors[0];
  return glm::normalize(Quat(q[0], q[1], q[2], q[3]));
}

struct Fit {
  Pose to_from;
  double square_sum_m2 = 0.0;
};

Fit fit(std::span<const PointPair> pairs, RegistrationFreedom freedom, double mirror) {
  const Centred points = centred(pairs, mirror);
  Fit out;
  out.to_from.rotation =
      freedom == RegistrationFreedom::kLevel ? level_turn(points) : free_turn(points);
  out.to_from.position_m = points.to_mean - out.to_from.rotation * points.from_mean;
  for (const auto& [a, b] : points.pairs) {
    const Vec3 miss = out.to_from.rotation * a - b;
    out.square_sum_m2 += glm::dot(miss, miss);
  }
  return out;
}

// How far the points lie, by root mean square, from the axis about which a turn moves them least:
// the vertical one, or that along which they stretch.
double spread_m(const Centred& points, RegistrationFreedom freedom, bool of_from) {
  std::array<std::array<double, 3>, 3> covariance{};
  const auto n = static_cast<double>(points.pairs.size());
  double level = 0.0;
  for (const PointPair& pair : points.pairs) {
    const Vec3& p = of_from ? pair.from_m : pair.to_m;
    level += (p.x * p.x + p.z * p.z) / n;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] += p[i] * p[j] / n;
  }
  if (freedom == RegistrationFreedom::kLevel) return std::sqrt(level);
  const auto eigen = eigen_of<3>(covariance);
  return std::sqrt(std::max(0.0, eigen.values[1]) + std::max(0.0, eigen.values[2]));
}

// By a turn, a shift and a scale: the best scale is that of the turned points' projection on the
// others.
struct Scaled {
  double scale = 1.0, rms_m = 0.0;
};
Scaled fit_scaled(std::span<const PointPair> pairs, RegistrationFreedom freedom) {
  const Centred points = centred(pairs, 1.0);
  const Quat turn = fit(pairs, freedom, 1.0).to_from.rotation;
  double along = 0.0, own = 0.0, square_m2 = 0.0;
  for (const auto& [a, b] : points.pairs) {
    along += glm::dot(turn * a, b);
    own += glm::dot(a, a);
  }
  if (!(own > 0.0) || !(along > 0.0)) return {1.0, std::numeric_limits<double>::infinity()};
  const double scale = along / own;
  for (const auto& [a, b] : points.pairs) {
    const Vec3 miss = scale * (turn * a) - b;
    square_m2 += glm::dot(miss, miss);
  }
  return {scale, std::sqrt(square_m2 / static_cast<double>(pairs.size()))};
}

// The international foot and inch: 0.3048 m and 0.0254 m (1959).
std::string units_of(double scale) {
  struct Unit {
    const char* name;
    double metres;
  };
  for (const Unit unit : {Unit{"millimetres", 0.001}, Unit{"centimetres", 0.01},
                          Unit{"inches", 0.0254}, Unit{"feet", 0.3048}}) {
    if (std::abs(std::log(scale / unit.metres)) < 0.02)
      return fmt::format("the lab's columns are in {}, accepted are metres", unit.name);
    if (std::abs(std::log(scale * unit.metres)) < 0.02)
      return fmt::format("the scene's columns are in {}, accepted are metres", unit.name);
  }
  return "accepted are metres on both sides";
}

}  // namespace

std::string misfit(std::span<const PointPair> pairs, RegistrationFreedom freedom,
                   const Registration& found) {
  // A survey by hand leaves residuals of kGood_m; a fit as good as that is accepted as it is.
  constexpr double kGood_m = 0.02, kBetter = 0.2, kWorst = 0.1;
  const auto n = static_cast<double>(pairs.size());
  const auto explains = [&](double rms_m) { return rms_m < kBetter * found.rms_m; };
  if (!(found.rms_m > kGood_m)) return {};
  const auto residuals = [&](double rms_m) {
    return fmt::format("{:.4f} m rms instead of {:.4f}", rms_m, found.rms_m);
  };
  if (explains(found.mirrored_rms_m))
    return fmt::format(
        "the pairs fit a mirrored frame ({}): one of the frames is left-handed, or "
        "two columns are exchanged",
        residuals(found.mirrored_rms_m));
  std::vector<RegistrationFreedom> freedoms{freedom};
  if (freedom != RegistrationFreedom::kFree && pairs.size() >= 3)
    freedoms.push_back(RegistrationFreedom::kFree);
  for (const RegistrationFreedom free : freedoms) {
    const Scaled scaled = fit_scaled(pairs, free);
    if (explains(scaled.rms_m) && std::abs(std::log(scaled.scale)) > 0.02)
      return fmt::format("the pairs fit where a lab's metre is {:.5g} m of the scene ({}): {}",
                         scaled.scale, residuals(scaled.rms_m), units_of(scaled.scale));
  }
  if (freedom == RegistrationFreedom::kLevel && pairs.size() >= 3) {
    const double free_m = std::sqrt(fit(pairs, RegistrationFreedom::kFree, 1.0).square_sum_m2 / n);
    if (explains(free_m))
      return fmt::format(
          "the pairs fit a frame whose y does not point up ({}): accepted are "
          "frames with y up, --lab-up z, or --tilted",
          residuals(free_m));
    const double mirrored_m =
        std::sqrt(fit(pairs, RegistrationFreedom::kFree, -1.0).square_sum_m2 / n);
    if (explains(mirrored_m))
      return fmt::format(
          "the pairs fit a frame that is mirrored and whose y does not point up "
          "({}): its axes are named otherwise than the scene's",
          residuals(mirrored_m));
  }
  const Centred points = centred(pairs, 1.0);
  double square_m2 = 0.0;
  for (const PointPair& pair : points.pairs) square_m2 += glm::dot(pair.to_m, pair.to_m) / n;
  if (found.rms_m < kWorst * std::sqrt(square_m2)) return {};
  const auto worst = std::ranges::max_element(found.residual_m);
  return fmt::format(
      "the pairs do not fit: {:.4f} m rms between places that lie {:.4f} m from "
      "their middle, the worst is pair {} with {:.4f} m",
      found.rms_m, std::sqrt(square_m2), worst - found.residual_m.begin() + 1, *worst);
}

Result<Registration> register_points(std::span<const PointPair> pairs,
                                     RegistrationFreedom freedom) {
  const bool level = freedom == RegistrationFreedom::kLevel;
  const std::size_t least = level ? 2 : 3;
  if (pairs.size() < least)
    return refusal("", fmt::format("{} pairs", pairs.size()), fmt::format("{} or more", least));
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (const Vec3& p : {pairs[i].from_m, pairs[i].to_m})
      for (int k = 0; k < 3; ++k)
        if (!(std::abs(p[k]) <= 1e9))
          return refusal(fmt::format("pair {}", i + 1), fmt::format("{}", p[k]),
                         "metres from -1e9 to 1e9");
  const Centred points = centred(pairs, 1.0);
  const double spread = std::min(spread_m(points, freedom, true), spread_m(points, freedom, false));
  if (!(spread >= kLeastSpread_m))
    return refusal("",
                   fmt::format("points that lie within {:.3f} m of {}", spread,
                               level ? "one vertical line" : "one line"),
                   fmt::format("points that spread {} m or more from it, so that the turn is known",
                               kLeastSpread_m));
  const Fit found = fit(pairs, freedom, 1.0);
  Registration out{.to_from = found.to_from};
  const auto n = static_cast<double>(pairs.size());
  out.rms_m = std::sqrt(found.square_sum_m2 / n);
  for (const auto& [a, b] : pairs) out.residual_m.push_back(glm::distance(out.to_from * a, b));
  const double unknowns = level ? 4.0 : 6.0;
  out.turn_error_rad = 3.0 * n > unknowns
                           ? std::sqrt(found.square_sum_m2 / (3.0 * n - unknowns) / n) / spread
                           : std::numeric_limits<double>::quiet_NaN();
  out.mirrored_rms_m = std::sqrt(fit(pairs, freedom, -1.0).square_sum_m2 / n);
  return out;
}

}  // namespace neritic
