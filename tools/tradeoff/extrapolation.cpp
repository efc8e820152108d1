#include "tools/tradeoff/extrapolation.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::tools {
namespace {

// Columns of the scheme: with n = 2, 4, ... 2 kColumns substeps the order is 2 kColumns.
constexpr int kColumns = 8;

// The modified midpoint rule over h in n substeps.
Vector midpoint(const Slope& slope, double t, const Vector& y, const Vector& slope0, double h,
                int n) {
  const double sub = h / n;
  Vector before = y, now = y;
  for (std::size_t i = 0; i < y.size(); ++i) now[i] += sub * slope0[i];
  for (int k = 1; k < n; ++k) {
    const Vector rate = slope(t + k * sub, now);
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double next = before[i] + 2.0 * sub * rate[i];
      before[i] = now[i];
      now[i] = next;
    }
  }
  const Vector rate = slope(t + h, now);
  for (std::size_t i = 0; i < y.size(); ++i) now[i] = 0.5 * (now[i] + before[i] + sub * rate[i]);
  return now;
}

struct Attempt {
  Vector y;
  double error = 0.0;  // over the tolerance
  int evaluations = 0;
};

// Aitken and Neville's table in h^2; error: between its last two columns.
Attempt attempt(const Slope& slope, double t, const Vector& y, double h, double tolerance) {
  const Vector slope0 = slope(t, y);
  std::vector<Vector> row;  // of the table, the newest
  Attempt out{{}, 0.0, 1};
  for (int k = 1; k <= kColumns; ++k) {
    std::vector<Vector> next{midpoint(slope, t, y, slope0, h, 2 * k)};
    out.evaluations += 2 * k;
    for (int j = 1; j < k; ++j) {
      const double ratio = static_cast<double>(k) / (k - j);
      const double weight = 1.0 / (ratio * ratio - 1.0);
      Vector finer = next.back();
      const Vector& coarser = row[static_cast<std::size_t>(j) - 1];
      for (std::size_t i = 0; i < y.size(); ++i) finer[i] += weight * (finer[i] - coarser[i]);
      next.push_back(std::move(finer));
    }
    row = std::move(next);
  }
  out.y = row.back();
  const Vector& lower = row[row.size() - 2];
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double scale = tolerance * (1.0 + std::abs(out.y[i]));
    const double error = std::abs(out.y[i] - lower[i]) / scale;
    out.error = error <= out.error ? out.error : error;  // keeps NaN
  }
  return out;
}

}  // namespace

Extrapolated extrapolate(const Slope& slope, double t0, double t1, Vector y, double tolerance) {
  Extrapolated out{std::move(y)};
  double t = t0, h = t1 - t0;
  while (t1 - t > 1e-13 * (std::abs(t1) + 1.0)) {
    h = std::min(h, t1 - t);
    const Attempt tried = attempt(slope, t, out.y, h, tolerance);
    out.evaluations += tried.evaluations;
    const bool good = tried.error <= 1.0;
    if (good) {
      t += h;
      out.y = tried.y;
      ++out.steps;
    }
    // The error between the last columns goes as h^(2 kColumns - 1).
    const double order = 2.0 * kColumns - 1.0;
    const double factor = std::isfinite(tried.error)
                              ? 0.9 * std::pow(std::max(tried.error, 1e-12), -1.0 / order)
                              : 0.1;
    h *= std::clamp(factor, 0.1, good ? 4.0 : 0.9);
    if (h < 1e-9 * (t1 - t0)) {
      out.converged = false;
      return out;
    }
  }
  return out;
}

}  // namespace neritic::tools
