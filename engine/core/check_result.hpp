// The result of checking a case: each quantity's worst error beside the tolerance that it has to
// stay under. Plain values; any thread.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace neritic {

// The larger; NaN if either is NaN, which std::max would drop.
inline double larger(double a, double b) {
  return std::isnan(a) || a >= b ? a : b;
}

struct CheckedError {
  std::string what, unit;
  double error = 0.0, tolerance = 0.0;
  double time_s = 0.0;  // of the worst
  // An error that is no number does not hold either.
  bool holds() const { return error <= tolerance; }
  double ratio() const { return error / tolerance; }
};

struct CaseResult {
  std::string id;
  std::vector<CheckedError> errors;  // at least one
  std::string note;                  // what of the case does not count as it stands; mostly empty

  bool ok() const {
    for (const CheckedError& e : errors)
      if (!e.holds()) return false;
    return true;
  }
  // The one nearest to its tolerance, or farthest beyond it.
  const CheckedError& worst() const {
    const CheckedError* worst = &errors.front();
    for (const CheckedError& e : errors)
      if (!(e.ratio() <= worst->ratio())) worst = &e;
    return *worst;
  }
};

}  // namespace neritic
