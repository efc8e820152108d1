// Six-vectors and 6 x 6 matrices of rigid bodies: three linear components, then three angular, in
// body axes. Fixed size, double, no allocation; pure functions, any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/math.hpp"

namespace neritic {
// [surge, sway, heave, roll, pitch, yaw]: a velocity (m/s, rad/s) or a wrench (N, N m).
struct Vec6 {
  std::array<double, 6> v{};

  double& operator[](std::size_t i) { return v[i]; }
  double operator[](std::size_t i) const { return v[i]; }
  Vec3 linear() const { return {v[0], v[1], v[2]}; }
  Vec3 angular() const { return {v[3], v[4], v[5]}; }
  bool operator==(const Vec6&) const = default;
  static void fields(auto&& field, auto& self) { field("v", self.v); }
};

inline Vec6 vec6(const Vec3& linear, const Vec3& angular) {
  return {{linear.x, linear.y, linear.z, angular.x, angular.y, angular.z}};
}
inline Vec6 operator+(Vec6 a, const Vec6& b) {
  for (std::size_t i = 0; i < 6; ++i) a[i] += b[i];
  return a;
}
inline Vec6 operator-(Vec6 a, const Vec6& b) {
  for (std::size_t i = 0; i < 6; ++i) a[i] -= b[i];
  return a;
}
inline Vec6 operator*(double s, Vec6 a) {
  for (std::size_t i = 0; i < 6; ++i) a[i] *= s;
  return a;
}
inline double dot(const Vec6& a, const Vec6& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}
inline bool is_finite(const Vec6& a) {
  for (const double x : a.v)
    if (!std::isfinite(x)) return false;
  return true;
}

// Rows first.
struct Mat6 {
  std::array<double, 36> m{};

  double& operator()(std::size_t row, std::size_t column) { return m[6 * row + column]; }
  double operator()(std::size_t row, std::size_t column) const { return m[6 * row + column]; }
  bool operator==(const Mat6&) const = default;
};

inline Mat6 diagonal(const Vec6& d) {
  Mat6 out;
  for (std::size_t i = 0; i < 6; ++i) out(i, i) = d[i];
  return out;
}
inline Vec6 operator*(const Mat6& a, const Vec6& x) {
  Vec6 out;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) out[i] += a(i, j) * x[j];
  return out;
}
inline Mat6 operator*(const Mat6& a, const Mat6& b) {
  Mat6 out;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 6; ++k)
      for (std::size_t j = 0; j < 6; ++j) out(i, j) += a(i, k) * b(k, j);
  return out;
}
inline Mat6 operator+(Mat6 a, const Mat6& b) {
  for (std::size_t i = 0; i < 36; ++i) a.m[i] += b.m[i];
  return a;
}
inline Mat6 operator*(double s, Mat6 a) {
  for (double& x : a.m) x *= s;
  return a;
}
inline Mat6 transpose(const Mat6& a) {
  Mat6 out;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) out(j, i) = a(i, j);
  return out;
}
inline Mat6 symmetric_part(const Mat6& a) {
  return 0.5 * (a + transpose(a));
}
inline bool is_finite(const Mat6& a) {
  for (const double x : a.m)
    if (!std::isfinite(x)) return false;
  return true;
}

// S(a) b = a x b, written into the 3 x 3 block of m at (row, column), times scale.
inline void set_cross(Mat6& m, std::size_t row, std::size_t column, const Vec3& a, double scale) {
  m(row, column + 1) = -scale * a.z;
  m(row, column + 2) = scale * a.y;
  m(row + 1, column) = scale * a.z;
  m(row + 1, column + 2) = -scale * a.x;
  m(row + 2, column) = -scale * a.y;
  m(row + 2, column + 1) = scale * a.x;
}

// Solves a x = b by Gaussian elimination with partial pivoting. False where a is singular to
// working precision; then x is unspecified.
inline bool solve(Mat6 a, Vec6 b, Vec6& x) {
  for (std::size_t k = 0; k < 6; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < 6; ++i)
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    if (!(std::abs(a(pivot, k)) > 0.0)) return false;
    if (pivot != k) {
      for (std::size_t j = k; j < 6; ++j) std::swap(a(k, j), a(pivot, j));
      std::swap(b[k], b[pivot]);
    }
    for (std::size_t i = k + 1; i < 6; ++i) {
      const double factor = a(i, k) / a(k, k);
      if (factor == 0.0) continue;
      for (std::size_t j = k; j < 6; ++j) a(i, j) -= factor * a(k, j);
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = 6; k-- > 0;) {
    double sum = b[k];
    for (std::size_t j = k + 1; j < 6; ++j) sum -= a(k, j) * x[j];
    x[k] = sum / a(k, k);
  }
  return is_finite(x);
}

// The smallest pivot of Cholesky's decomposition of the symmetric a, scaled to a unit diagonal:
// above 0 exactly where a is positive definite, and near 0 where it is nearly singular.
inline double smallest_pivot(const Mat6& a) {
  Mat6 l;
  double smallest = 1.0;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!(a(i, i) > 0.0)) return a(i, i) < 0.0 ? -1.0 : 0.0;
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a(i, j) / std::sqrt(a(i, i)) / std::sqrt(a(j, j));
      for (std::size_t k = 0; k < j; ++k) sum -= l(i, k) * l(j, k);
      if (i == j) {
        smallest = std::min(smallest, sum);
        if (!(sum > 0.0)) return sum;
        l(i, i) = std::sqrt(sum);
      } else {
        l(i, j) = sum / l(j, j);
      }
    }
  }
  return smallest;
}

// Precondition: a is not singular.
inline Mat6 inverse(const Mat6& a) {
  Mat6 out;
  for (std::size_t j = 0; j < 6; ++j) {
    Vec6 unit, x;
    unit[j] = 1.0;
    solve(a, unit, x);
    for (std::size_t i = 0; i < 6; ++i) out(i, j) = x[i];
  }
  return out;
}

}  // namespace neritic
