#include "diver/added_mass.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/math.hpp"

namespace neritic::diver {

SpheroidAddedMass spheroid_added_mass(double slenderness) {
  // Closer to a sphere the closed form loses its digits.
  const double ratio = std::max(slenderness, 1.0001);
  const double e2 = 1.0 - 1.0 / (ratio * ratio), e = std::sqrt(e2);
  const double log_term = std::log((1.0 + e) / (1.0 - e));
  const double alpha = 2.0 * (1.0 - e2) / (e2 * e) * (0.5 * log_term - e);
  const double beta = 1.0 / e2 - (1.0 - e2) / (2.0 * e2 * e) * log_term;
  const double turning =
      e2 * e2 * (beta - alpha) / ((2.0 - e2) * (2.0 * e2 - (2.0 - e2) * (beta - alpha)));
  return {alpha / (2.0 - alpha), beta / (2.0 - beta), turning};
}

double section_added_mass(double water_kg_m3, double half_width_m) {
  return water_kg_m3 * kPi * half_width_m * half_width_m;
}

double section_added_inertia(double water_kg_m3, double half_width_m, double half_depth_m) {
  const double d = half_width_m * half_width_m - half_depth_m * half_depth_m;
  return water_kg_m3 * kPi / 8.0 * d * d;
}

}  // namespace neritic::diver
