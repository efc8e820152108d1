#include "rov/bluerov2.hpp"

#include <numbers>

namespace neritic::rov {
namespace {

constexpr double kVolume = 0.0134;  // m^3

Mat3 diagonal_inertia(double x, double y, double z) {
  Mat3 m(0.0);
  m[0][0] = x;
  m[1][1] = y;
  m[2][2] = z;
  return m;
}

}  // namespace

VehicleParameters bluerov2_heavy(double water_kg_m3) {
  VehicleParameters p;
  p.name = "BlueROV2 Heavy (von Benzon 2022)";
  p.mass_kg = 13.5;
  p.inertia_kg_m2 = diagonal_inertia(0.26, 0.23, 0.37);
  p.buoyancy_centre_m = {0.0, 0.0, -0.01};
  p.weight_n = p.mass_kg * kGravity;
  p.buoyancy_n = water_kg_m3 * kVolume * kGravity;
  p.added_mass = diagonal({{6.36, 7.12, 18.68, 0.189, 0.135, 0.222}});
  p.linear_damping = diagonal({{13.7, 0.0, 33.0, 0.0, 0.8, 0.0}});
  p.quadratic_damping = {{141.0, 217.0, 190.0, 1.19, 0.47, 1.5}};
  p.thrusters = heavy_thrusters();
  p.lag.kind = ThrusterLag::Kind::kThirdOrder;
  return p;
}

VehicleParameters bluerov2_heavy_manual(double water_kg_m3) {
  VehicleParameters p = bluerov2_heavy(water_kg_m3);
  p.name = "BlueROV2 Heavy, ballasted for manual flight";
  p.buoyancy_centre_m = {0.0, 0.0, -0.03};
  return p;
}

VehicleParameters bluerov2_wu2018() {
  VehicleParameters p;
  p.name = "BlueROV2 (Wu 2018)";
  p.mass_kg = 11.5;
  p.inertia_kg_m2 = diagonal_inertia(0.16, 0.16, 0.16);
  p.gravity_centre_m = {0.0, 0.0, 0.02};
  p.weight_n = 112.8;
  p.buoyancy_n = 114.8;
  p.added_mass = diagonal({{5.5, 12.7, 14.57, 0.12, 0.12, 0.12}});
  p.linear_damping = diagonal({{4.03, 6.22, 5.18, 0.07, 0.07, 0.07}});
  p.quadratic_damping = {{18.18, 21.66, 36.99, 1.55, 1.55, 1.55}};
  p.thrusters = heavy_thrusters();
  p.lag.kind = ThrusterLag::Kind::kThirdOrder;
  return p;
}

std::vector<Thruster> heavy_thrusters() {
  constexpr double c = std::numbers::sqrt2 / 2.0;
  std::vector<Thruster> out;
  const auto add = [&out](const Vec3& position, const Vec3& direction) {
    out.push_back({position, direction, kT200Min16V, kT200Max16V});
  };
  add({0.156, 0.111, 0.085}, {c, -c, 0.0});
  add({0.156, -0.111, 0.085}, {c, c, 0.0});
  add({-0.156, 0.111, 0.085}, {-c, -c, 0.0});
  add({-0.156, -0.111, 0.085}, {-c, c, 0.0});
  for (const double x : {0.12, -0.12})
    for (const double y : {0.218, -0.218}) add({x, y, 0.0}, {0.0, 0.0, -1.0});
  return out;
}

double von_benzon_thrust_n(double v) {
  const double v2 = v * v;
  return v * (8.9 + v2 * (176.0 + v2 * (-404.1 + v2 * (389.9 - 140.3 * v2))));
}

}  // namespace neritic::rov
