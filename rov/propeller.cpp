#include "rov/propeller.hpp"

#include <cmath>

namespace neritic::rov {

double propeller_hz(const Thruster& thruster, double force_n, double water_kg_m3) {
  constexpr double kThrust = 0.44;  // C_T
  const double d2 = thruster.propeller_m * thruster.propeller_m;
  if (!std::isfinite(force_n) || !(d2 > 0.0)) return 0.0;
  return std::copysign(std::sqrt(std::abs(force_n) / (kThrust * water_kg_m3)) / d2, force_n);
}

}  // namespace neritic::rov
