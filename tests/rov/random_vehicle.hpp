// The vehicles that tests fly: the BlueROV2 Heavy, and vehicles and motions drawn at random, the
// same for the same index on any machine.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.hpp"
#include "rov/bluerov2.hpp"
#include "rov/dynamics.hpp"

namespace neritic::rov {

inline Vehicle heavy_vehicle(double water_kg_m3 = kSeaDensity, bool neutral = false) {
  VehicleParameters p = bluerov2_heavy(water_kg_m3);
  if (neutral) p.buoyancy_n = p.weight_n;
  return make_vehicle(p).value();
}

class Draws {
 public:
  explicit Draws(std::uint64_t index) : key_{20260101, 7, index} {}
  double uniform(double from, double to) {
    return from + (to - from) * random_uniform(key_, count_++);
  }
  // Spread evenly over orders of magnitude.
  double scale(double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); }
  Vec3 vec3(double most) {
    return {uniform(-most, most), uniform(-most, most), uniform(-most, most)};
  }
  Quat attitude() {
    Quat q(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    return glm::length(q) > 1e-3 ? glm::normalize(q) : Quat(1.0, 0.0, 0.0, 0.0);
  }

 private:
  RandomKey key_;
  std::uint64_t count_ = 0;
};

// A positive definite matrix with this diagonal and couplings up to share of it.
inline Mat6 coupled(Draws& draws, const Vec6& d, double share) {
  Mat6 m = diagonal(d);
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < i; ++j)
      m(i, j) = m(j, i) = share * draws.uniform(-1, 1) * std::sqrt(d[i] * d[j]);
  return m;
}

// From a tenth of a kilogram to a tonne, light and heavy in water, drag of every kind.
inline Vehicle random_vehicle(Draws& draws) {
  VehicleParameters p;
  p.mass_kg = draws.scale(0.1, 1000.0);
  const double size = std::cbrt(p.mass_kg / 1000.0);
  p.gravity_centre_m = draws.vec3(0.1 * size);
  p.buoyancy_centre_m = draws.vec3(0.1 * size);
  for (int i = 0; i < 3; ++i)
    p.inertia_kg_m2[i][i] = p.mass_kg * size * size * draws.uniform(0.15, 0.25);
  p.weight_n = p.mass_kg * 9.82;
  p.buoyancy_n = p.weight_n * draws.uniform(0.9, 1.1);
  Vec6 added, linear;
  for (std::size_t i = 0; i < 6; ++i) {
    const double unit = i < 3 ? p.mass_kg : p.mass_kg * size * size;
    added[i] = unit * draws.uniform(0.1, 2.0);
    linear[i] = unit * draws.scale(1e-3, 3.0);
    p.quadratic_damping[i] = unit * draws.scale(1e-2, 30.0);
  }
  p.added_mass = coupled(draws, added, 0.15);
  p.linear_damping = coupled(draws, linear, 0.15);
  for (int i = 0; i < 6; ++i)
    p.thrusters.push_back({draws.vec3(size), draws.attitude() * Vec3(1.0, 0.0, 0.0)});
  p.lag.kind = ThrusterLag::Kind::kThirdOrder;
  auto vehicle = make_vehicle(p);
  EXPECT_TRUE(vehicle.ok()) << vehicle.error().message;
  return *vehicle;
}

inline State random_state(Draws& draws, double speed) {
  State state;
  state.position_ned_m = draws.vec3(50.0);
  state.attitude = draws.attitude();
  state.velocity = vec6(draws.vec3(speed), draws.vec3(2.0 * speed));
  return state;
}

inline bool all_finite(const State& state) {
  bool finite = is_finite(state.position_ned_m) && is_finite(state.velocity) &&
                std::abs(glm::length(state.attitude) - 1.0) < 1e-9;
  for (const LagState& lag : state.lag)
    for (const double x : lag) finite = finite && std::isfinite(x);
  return finite;
}

}  // namespace neritic::rov
