#include "engine/core/water_column.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace neritic {

double WaterLayer::sigma_m() const {
  return thickness_m / std::sqrt(2.0 * std::numbers::pi);
}

SeaWater WaterColumn::at(double depth_m) const {
  SeaWater out{temperature_c, salinity_psu}, above = out;
  for (const WaterLayer& layer : layers()) {
    const double share =
        0.5 * std::erfc((layer.depth_m - depth_m) / (std::sqrt(2.0) * layer.sigma_m()));
    out.temperature_c += share * (layer.temperature_c - above.temperature_c);
    out.salinity_psu += share * (layer.salinity_psu - above.salinity_psu);
    above = {layer.temperature_c, layer.salinity_psu};
  }
  return out;
}

double WaterColumn::density_kg_m3(double depth_m) const {
  return sea_density_kg_m3(at(depth_m));
}

double WaterColumn::sound_speed_m_s(double depth_m) const {
  return sea_sound_speed_m_s(at(depth_m), depth_m);
}

double sea_density_kg_m3(const SeaWater& water) {
  const double t = water.temperature_c, s = std::max(water.salinity_psu, 0.0);
  const double pure =
      999.842594 +
      t * (6.793952e-2 +
           t * (-9.095290e-3 + t * (1.001685e-4 + t * (-1.120083e-6 + t * 6.536332e-9))));
  const double a =
      8.24493e-1 + t * (-4.0899e-3 + t * (7.6438e-5 + t * (-8.2467e-7 + t * 5.3875e-9)));
  const double b = -5.72466e-3 + t * (1.0227e-4 - t * 1.6546e-6);
  return pure + s * (a + b * std::sqrt(s) + 4.8314e-4 * s);
}

double sea_sound_speed_m_s(const SeaWater& water, double depth_m) {
  const double t = water.temperature_c, s = water.salinity_psu - 35.0, d = depth_m;
  return 1448.96 + 4.591 * t - 5.304e-2 * t * t + 2.374e-4 * t * t * t + 1.340 * s + 1.630e-2 * d +
         1.675e-7 * d * d - 1.025e-2 * t * s - 7.139e-13 * t * d * d * d;
}

double sea_refractive_index(const SeaWater& water, double wavelength_nm) {
  const double t = water.temperature_c, s = water.salinity_psu, l = wavelength_nm;
  return 1.31405 + (1.779e-4 - 1.05e-6 * t + 1.6e-8 * t * t) * s - 2.02e-6 * t * t +
         (15.868 + 0.01155 * s - 0.00423 * t) / l - 4382.0 / (l * l) + 1.1455e6 / (l * l * l);
}

}  // namespace neritic
