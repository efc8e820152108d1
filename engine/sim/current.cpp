// Currents that are a formula, and what all kinds share.
#include "engine/sim/current.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/sim/current_grid.hpp"

namespace neritic::sim {
namespace {

Status check_speed(const char* what, const Vec3& velocity_m_s) {
  if (glm::length(velocity_m_s) <= kMaxCurrent_m_s) return {};
  return refusal(what,
                 fmt::format("({}, {}, {}) m/s", velocity_m_s.x, velocity_m_s.y, velocity_m_s.z),
                 fmt::format("up to {} m/s", kMaxCurrent_m_s));
}

Status check_depth(double depth_m) {
  if (std::isfinite(depth_m) && depth_m > 0.0) return {};
  return refusal("depth_m", fmt::format("{}", depth_m), "above 0");
}

struct CheckCurrent {
  Status operator()(const UniformCurrent& current) const {
    return check_speed("velocity_m_s", current.velocity_m_s);
  }
  Status operator()(const PowerLawCurrent& current) const {
    NERITIC_TRY_STATUS(check_depth(current.depth_m));
    if (!(current.exponent > 0.0 && current.exponent <= 1.0))
      return refusal("exponent", fmt::format("{}", current.exponent), "above 0 to 1");
    return check_speed("surface_velocity_m_s", current.surface_velocity_m_s);
  }
  Status operator()(const LinearCurrent& current) const {
    NERITIC_TRY_STATUS(check_depth(current.depth_m));
    NERITIC_TRY_STATUS(check_speed("surface_velocity_m_s", current.surface_velocity_m_s));
    return check_speed("deep_velocity_m_s", current.deep_velocity_m_s);
  }
  Status operator()(const GridCurrent& current) const { return check_grid(current); }
};

struct SampleCurrent {
  const Vec3& position_m;
  double time_s;

  CurrentSample operator()(const UniformCurrent& current) const { return {current.velocity_m_s}; }
  CurrentSample operator()(const PowerLawCurrent& current) const {
    const double height = (current.depth_m + position_m.y) / current.depth_m;  // 0 bed, 1 surface
    if (height >= 1.0) return {current.surface_velocity_m_s};
    if (height <= 0.0) return {};
    const double share = std::pow(height, current.exponent);
    constexpr double kNearBed = 1e-3;
    const double slope = height > kNearBed ? current.exponent * share / height
                                           : std::pow(kNearBed, current.exponent - 1.0);
    CurrentSample sample{current.surface_velocity_m_s * share};
    sample.gradient_per_s[1] = current.surface_velocity_m_s * (slope / current.depth_m);
    return sample;
  }
  CurrentSample operator()(const LinearCurrent& current) const {
    const double depth = -position_m.y / current.depth_m;
    const Vec3 change_m_s = current.deep_velocity_m_s - current.surface_velocity_m_s;
    CurrentSample sample{current.surface_velocity_m_s + change_m_s * std::clamp(depth, 0.0, 1.0)};
    if (depth > 0.0 && depth < 1.0) sample.gradient_per_s[1] = -change_m_s / current.depth_m;
    return sample;
  }
  CurrentSample operator()(const GridCurrent& current) const {
    return sample_grid(current, position_m, time_s);
  }
};

}  // namespace

std::string_view name_of(const Current& current) {
  constexpr std::string_view kNames[] = {"uniform", "power_law", "linear", "grid"};
  static_assert(std::size(kNames) == std::variant_size_v<Current>);
  return kNames[current.index()];
}

Status check_current(const Current& current) {
  return std::visit(CheckCurrent{}, current);
}

CurrentSample sample(const Current& current, const Vec3& position_m, double time_s) {
  return std::visit(SampleCurrent{position_m, time_s}, current);
}

}  // namespace neritic::sim
