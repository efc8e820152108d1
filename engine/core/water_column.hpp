// Temperature and salinity of the water over depth, in layers: the one profile from which come the
// density that carries bodies, the speed of sound, the refractive index of pictures and the cold
// of divers. Depths are positive downwards. Trivially copyable; any thread.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "engine/core/math.hpp"

namespace neritic {

// Water from a depth on, below a transition as diffusion leaves it: an error function about
// depth_m, whose steepest gradient would make the whole step within thickness_m.
struct WaterLayer {
  double depth_m = 0.0, thickness_m = 0.5;
  double temperature_c = 10.0, salinity_psu = 35.0;  // below the transition
  // Waves of the transition: root mean square of their slopes, and their lengths.
  double slope = 0.1, shortest_m = 0.2, longest_m = 2.0;
  // Deviation of the transition's Gaussian gradient.
  double sigma_m() const;
  bool operator==(const WaterLayer&) const = default;
};

struct SeaWater {
  double temperature_c = 10.0, salinity_psu = 35.0;
};

struct WaterColumn {
  double temperature_c = 10.0, salinity_psu = 35.0;  // above the first layer
  std::array<WaterLayer, 4> layer{};                 // from the surface down
  std::size_t count = 0;                             // of them

  std::span<const WaterLayer> layers() const { return {layer.data(), count}; }
  SeaWater at(double depth_m) const;
  // As the equations below have them of the water there.
  double density_kg_m3(double depth_m) const;
  double sound_speed_m_s(double depth_m) const;
  bool operator==(const WaterColumn&) const = default;
};

// Sea water at one atmosphere, kg/m^3: EOS-80 (Millero and Poisson 1981; UNESCO 1983, technical
// paper 44), -2 to 40 C, 0 to 42 psu. Compression is left out: bodies are compressed as well.
double sea_density_kg_m3(const SeaWater& water);
// Mackenzie 1981, "Nine-term equation for sound speed in the oceans", JASA 70, 807. Published for
// 2 to 30 C, 25 to 40 psu, 0 to 8000 m.
double sea_sound_speed_m_s(const SeaWater& water, double depth_m);
// Refractive index against air: Quan and Fry 1995, Applied Optics 34, 3477, eq. 3; 0 to 30 C, 0 to
// 35 psu, 400 to 700 nm.
double sea_refractive_index(const SeaWater& water, double wavelength_nm);

}  // namespace neritic
