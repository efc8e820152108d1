#include "rov/wash.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace neritic::rov {

double jet_exit_m_s(const WashJet& jet, double water_kg_m3) {
  const double area_m2 = std::numbers::pi / 4.0 * jet.diameter_m * jet.diameter_m;
  const double flux = water_kg_m3 * area_m2;
  return flux > 0.0 ? std::sqrt(std::max(0.0, jet.thrust_n) / flux) : 0.0;
}

double jet_axis_m_s(const WashJet& jet, double x_m, double water_kg_m3) {
  if (!(x_m >= 0.0)) return 0.0;
  const double core_m = kJetDecay * jet.diameter_m;
  return jet_exit_m_s(jet, water_kg_m3) * (x_m <= core_m ? 1.0 : core_m / x_m);
}

double jet_half_width_m(const WashJet& jet, double x_m, double water_kg_m3) {
  const double axis_m_s = jet_axis_m_s(jet, x_m, water_kg_m3);
  if (!(axis_m_s > 0.0)) return 0.0;
  return std::sqrt(2.0 * std::numbers::ln2 * jet.thrust_n /
                   (std::numbers::pi * water_kg_m3 * axis_m_s * axis_m_s));
}

Vec3 jet_velocity_m_s(const WashJet& jet, const Vec3& point_m, double water_kg_m3) {
  const Vec3 off = point_m - jet.from_m;
  const double x_m = glm::dot(off, jet.along);
  const double axis_m_s = jet_axis_m_s(jet, x_m, water_kg_m3);
  if (!(axis_m_s > 0.0)) return Vec3(0.0);
  const double width_m = jet_half_width_m(jet, x_m, water_kg_m3);
  const double aside_m = glm::length(off - x_m * jet.along);
  const double across = aside_m / width_m;
  return axis_m_s * std::exp(-std::numbers::ln2 * across * across) * jet.along;
}

double ground_effect(double diameter_m, double distance_m) {
  const double radius_m = 0.5 * diameter_m;
  const double ratio = radius_m / (4.0 * std::max(distance_m, radius_m));
  return 1.0 / (1.0 - ratio * ratio);
}

}  // namespace neritic::rov
