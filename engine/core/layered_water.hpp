// Integrals over a water column: the weight of the water above a depth, and the travel time of
// sound between depths. Trivially copyable; built once, then only read; any thread.
#pragma once

#include <array>
#include <cstddef>

#include "engine/core/water_column.hpp"

namespace neritic {

class LayeredWater {
 public:
  explicit LayeredWater(const WaterColumn& column);

  const WaterColumn& column() const { return column_; }
  double density_kg_m3(double depth_m) const { return column_.density_kg_m3(depth_m); }
  // The mass of the water above a square metre at that depth, kg/m^2: the integral of density_kg_m3
  // from the surface down, to 1e-9 of it. 0 above the surface. Times the acceleration of gravity it
  // is the pressure over that of the air.
  double mass_above_kg_m2(double depth_m) const;
  // The mean of 1 / sound_speed_m_s between two depths, s/m: times the length of a straight path
  // between them it is the travel time of sound along that path. Rays bend, which saves less than
  // 1e-3 of the time where the path is steeper than 1 in 10.
  double mean_slowness_s_m(double from_depth_m, double to_depth_m) const;

 private:
  // Gauss's rule with four points is exact to 1e-9 of the integral over a cell between two nodes.
  static constexpr int kCellsALayer = 24;
  static constexpr std::size_t kMostNodes = 1 + 4 * (kCellsALayer + 1);
  // Nodes below that depth.
  std::size_t nodes_above(double depth_m) const;

  WaterColumn column_;
  // Depths from the surface down, and the mass above each.
  std::array<double, kMostNodes> depth_m_{}, mass_kg_m2_{};
  std::size_t count_ = 0;
};

}  // namespace neritic
