// A lamp's beam by angle, as a data sheet gives it. Plain values; any thread.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/core/math.hpp"

namespace neritic::scene {

// Intensity over that of the axis at angles of even steps of sqrt(1 - cos angle) from the axis to
// the edge, beyond which there is none; linear between.
struct LampProfile {
  static constexpr std::size_t kSteps = 16;
  double edge_rad = 0.0;
  std::array<float, kSteps> share{};

  double at(double angle_rad) const;
  // Its integral over all directions: the flux of a lamp of 1 cd on its axis, lm.
  double solid_angle_sr() const;
};

// 2^-(angle / half)^2, to where a hundredth is left or to 90 degrees.
LampProfile gaussian_profile(double half_intensity_rad);
// Angles (rad, rising from 0) and shares, linear between.
LampProfile table_profile(const std::vector<std::pair<double, double>>& rows);
// The solid angle of a cone whose cosine has a smooth step between the two angles
// (shaders/shared/water.glsl), sr.
double cone_solid_angle_sr(double inner_rad, double outer_rad);

}  // namespace neritic::scene
