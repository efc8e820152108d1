#include "engine/scene/lamp_profile.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::scene {
namespace {

double step_of(const LampProfile& profile, double cosine) {
  const double whole = std::max(1.0 - std::cos(profile.edge_rad), 1e-12);
  return std::sqrt(std::max(1.0 - cosine, 0.0) / whole) * (LampProfile::kSteps - 1);
}

double angle_of(const LampProfile& profile, std::size_t step) {
  const double u = double(step) / (LampProfile::kSteps - 1);
  return std::acos(1.0 - u * u * (1.0 - std::cos(profile.edge_rad)));
}

}  // namespace

double LampProfile::at(double angle_rad) const {
  const double step = step_of(*this, std::cos(std::clamp(angle_rad, 0.0, kPi)));
  if (!(step <= kSteps - 1)) return 0.0;
  const auto low = std::min(static_cast<std::size_t>(step), kSteps - 2);
  return std::lerp(double(share[low]), double(share[low + 1]), step - double(low));
}

double LampProfile::solid_angle_sr() const {
  // With 1 - cos = u^2 (1 - cos edge): the integral of share(u) 2 pi 2 u (1 - cos edge) du, exactly
  // where share is linear.
  const double whole = 1.0 - std::cos(edge_rad);
  const double du = 1.0 / (kSteps - 1);
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < kSteps; ++i) {
    const double u = double(i) * du, a = share[i], b = share[i + 1];
    sum += du * (u * 0.5 * (a + b) + du * (a / 6.0 + b / 3.0));
  }
  return 4.0 * kPi * whole * sum;
}

LampProfile gaussian_profile(double half_intensity_rad) {
  LampProfile profile;
  profile.edge_rad = std::min(half_intensity_rad * std::sqrt(std::log2(100.0)), kPi / 2.0);
  for (std::size_t i = 0; i < LampProfile::kSteps; ++i) {
    const double angles = angle_of(profile, i) / half_intensity_rad;
    profile.share[i] = static_cast<float>(std::exp2(-angles * angles));
  }
  return profile;
}

LampProfile table_profile(const std::vector<std::pair<double, double>>& rows) {
  LampProfile profile;
  profile.edge_rad = rows.back().first;
  for (std::size_t i = 0; i < LampProfile::kSteps; ++i) {
    const double angle = angle_of(profile, i);
    std::size_t high = 1;
    while (high + 1 < rows.size() && rows[high].first < angle) ++high;
    const auto& [a0, s0] = rows[high - 1];
    const auto& [a1, s1] = rows[high];
    profile.share[i] =
        static_cast<float>(std::lerp(s0, s1, std::clamp((angle - a0) / (a1 - a0), 0.0, 1.0)));
  }
  return profile;
}

double cone_solid_angle_sr(double inner_rad, double outer_rad) {
  return 2.0 * kPi * (1.0 - 0.5 * (std::cos(inner_rad) + std::cos(outer_rad)));
}

}  // namespace neritic::scene
