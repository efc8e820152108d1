#include "rov/ventilation.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/math.hpp"

namespace neritic::rov {
namespace {

constexpr double kLoss = 0.675, kLossPower = 1.258;
constexpr double kLeastHalfHeight = 0.5;  // of the radius: a nozzle's that lies

// The share of a disc's area under water, if its middle is x of its half height deep, -1 to 1.
double submerged_share(double x) {
  return 0.5 + (x * std::sqrt(1.0 - x * x) + std::asin(x)) / kPi;
}

}  // namespace

double thrust_share(double depth_m, double radius_m, double shaft_down) {
  if (std::isnan(depth_m) || std::isnan(radius_m) || std::isnan(shaft_down)) return 1.0;
  const double deepest_m = kVentilatedRadii * std::max(radius_m, 0.0);
  if (depth_m >= deepest_m) return 1.0;
  if (depth_m >= 0.0) return 1.0 - kLoss * std::pow(1.0 - depth_m / deepest_m, kLossPower);
  const double level = std::sqrt(std::max(1.0 - shaft_down * shaft_down, 0.0));
  const double half_m = std::max(radius_m, 0.0) * std::max(level, kLeastHalfHeight);
  if (!(depth_m > -half_m)) return 0.0;
  return 2.0 * (1.0 - kLoss) * submerged_share(depth_m / half_m);
}

}  // namespace neritic::rov
