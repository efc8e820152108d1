// Where a dive is done: the air's pressure at the surface and what a metre of water adds. Plain
// values; any thread. Pressures in bar (absolute), depths in metres, as tables and computers have
// them.
#pragma once

#include <cmath>

namespace neritic::diver {

inline constexpr double kStandardSurface_bar = 1.01325;
inline constexpr double kStandardGravity_m_s2 = 9.80665;

struct DecoEnvironment {
  double surface_bar = kStandardSurface_bar;
  double bar_per_m = 0.09985;

  double pressure_bar(double depth_m) const { return surface_bar + bar_per_m * depth_m; }
  double depth_m(double pressure_bar) const { return (pressure_bar - surface_bar) / bar_per_m; }

  static void fields(auto&& field, auto& self) {
    field("surface_bar", self.surface_bar);
    field("bar_per_m", self.bar_per_m);
  }
};

// The convention of tables of limits: 1 bar, and 10 m of water a bar.
inline constexpr DecoEnvironment kTenMetresABar{1.0, 0.1};

inline double bar_per_m_of(double density_kg_m3, double gravity_m_s2 = kStandardGravity_m_s2) {
  return 1e-5 * density_kg_m3 * gravity_m_s2;
}

// The standard atmosphere's pressure, troposphere (U.S. Standard Atmosphere 1976, eq. 33a, with its
// own gas constant): 0 to 11 km. 1500 m give 0.845560 bar.
inline double surface_bar_at(double altitude_m) {
  constexpr double kLapse_K_m = 0.0065, kSea_K = 288.15;
  constexpr double kExponent = kStandardGravity_m_s2 * 0.0289644 / (8.31432 * kLapse_K_m);
  return kStandardSurface_bar * std::pow(1.0 - kLapse_K_m * altitude_m / kSea_K, kExponent);
}

}  // namespace neritic::diver
