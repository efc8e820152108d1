#include "engine/core/layered_water.hpp"

#include <algorithm>
#include <cmath>

namespace neritic {
namespace {

// So many deviations from a transition's middle the density is that of one side to 1e-9.
constexpr double kWide = 6.0;
// Below the transitions the speed of sound changes with depth alone, so slowly that cells may be
// this long.
constexpr double kLongest_m = 500.0;

// Gauss-Legendre with four points (Abramowitz and Stegun 1964, table 25.4).
template <class Function>
double integral(double from, double to, const Function& function) {
  constexpr double kAt[] = {0.339981043584856, 0.861136311594053};
  constexpr double kWeight[] = {0.652145154862546, 0.347854845137454};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0.0;
  for (int i = 0; i < 2; ++i)
    sum += kWeight[i] * (function(middle - half * kAt[i]) + function(middle + half * kAt[i]));
  return half * sum;
}

}  // namespace

LayeredWater::LayeredWater(const WaterColumn& column) : column_(column) {
  depth_m_[count_++] = 0.0;
  for (const WaterLayer& layer : column_.layers())
    for (int i = 0; i <= kCellsALayer; ++i) {
      const double off = kWide * (2.0 * i / kCellsALayer - 1.0);
      const double depth_m = layer.depth_m + off * layer.sigma_m();
      if (depth_m > 0.0) depth_m_[count_++] = depth_m;
    }
  std::sort(depth_m_.begin(), depth_m_.begin() + static_cast<std::ptrdiff_t>(count_));
  for (std::size_t i = 1; i < count_; ++i)
    mass_kg_m2_[i] = mass_kg_m2_[i - 1] + integral(depth_m_[i - 1], depth_m_[i], [&](double z) {
                       return column_.density_kg_m3(z);
                     });
}

std::size_t LayeredWater::nodes_above(double depth_m) const {
  const auto end = depth_m_.begin() + static_cast<std::ptrdiff_t>(count_);
  return static_cast<std::size_t>(std::lower_bound(depth_m_.begin(), end, depth_m) -
                                  depth_m_.begin());
}

double LayeredWater::mass_above_kg_m2(double depth_m) const {
  const std::size_t above = nodes_above(depth_m);
  if (above == 0) return 0.0;
  return mass_kg_m2_[above - 1] +
         integral(depth_m_[above - 1], depth_m, [&](double z) { return column_.density_kg_m3(z); });
}

double LayeredWater::mean_slowness_s_m(double from_depth_m, double to_depth_m) const {
  constexpr double kLevel_m = 1e-6;
  const auto slowness = [&](double z) { return 1.0 / column_.sound_speed_m_s(z); };
  const double top_m = std::min(from_depth_m, to_depth_m);
  const double bottom_m = std::max(from_depth_m, to_depth_m);
  if (bottom_m - top_m < kLevel_m) return slowness(0.5 * (top_m + bottom_m));
  double sum_s = 0.0, at_m = top_m;
  for (std::size_t node = nodes_above(top_m); at_m < bottom_m;) {
    double next_m = std::min(bottom_m, at_m + kLongest_m);
    if (node < count_ && depth_m_[node] <= next_m) next_m = depth_m_[node++];
    sum_s += integral(at_m, next_m, slowness);
    at_m = next_m;
  }
  return sum_s / (bottom_m - top_m);
}

}  // namespace neritic
