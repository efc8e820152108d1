#include "diver/limb_filter.hpp"

#include <cmath>

namespace neritic::diver {
namespace {

constexpr double kThere = 1e-12;  // rad, rad/s

// The rotation as a vector, at most pi long.
Vec3 log_of(const Quat& q) {
  const Vec3 v(q.x, q.y, q.z);
  const double s = glm::length(v);
  if (s < 1e-9) return (q.w < 0.0 ? -2.0 : 2.0) * v;
  const double angle = 2.0 * std::atan2(q.w < 0.0 ? -s : s, std::abs(q.w));
  return (angle / s) * v;
}

Quat exp_of(const Vec3& v) {
  const double angle = glm::length(v);
  // sin(a/2)/a to the fourth power of small angles.
  const double k = angle < 1e-3 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), k * v.x, k * v.y, k * v.z};
}

}  // namespace

int follow_limbs(LimbState& limbs, const JointRotations& wanted, double dt_s) {
  // e'' + 2 s e' + 2 s^2 e = 0 for what is left to go, e' = -rate: damping 1/sqrt 2.
  const double s = 2.0 * kPi * kLimbCutoff_hz * std::sqrt(0.5);
  const double decay = std::exp(-s * dt_s), c = decay * std::cos(s * dt_s),
               n = decay * std::sin(s * dt_s);
  int far = 0;
  for (std::size_t i = 0; i < kJoints; ++i) {
    Vec3 left = log_of(glm::conjugate(limbs.rotation[i]) * wanted[i]);
    const double angle = glm::length(left);
    if (angle > kMostLag_rad) {
      left *= kMostLag_rad / angle;
      ++far;
    }
    const Vec3 rate = limbs.rate[i];
    // There: what is left would go on to shrink into numbers that processors are slow with.
    if (angle < kThere && glm::dot(rate, rate) < kThere * kThere) {
      limbs.rotation[i] = wanted[i];
      limbs.rate[i] = Vec3(0.0);
      continue;
    }
    const Vec3 now_left = (c + n) * left - (n / s) * rate;
    limbs.rate[i] = 2.0 * s * n * left + (c - n) * rate;
    limbs.rotation[i] = glm::normalize(limbs.rotation[i] * exp_of(left - now_left));
  }
  return far;
}

}  // namespace neritic::diver
