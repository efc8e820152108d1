#include "rov/vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "rov/ventilation.hpp"

namespace neritic::rov {
namespace {

// Below this a mass matrix (scaled to a unit diagonal) counts as singular.
constexpr double kSingular = 1e-9;
constexpr double kLargest = 1e9;  // of any parameter, in SI units

bool within(double value, double least) {
  return value >= least && value <= kLargest;
}
Status check_scalars(const VehicleParameters& p) {
  if (!(p.mass_kg > 0.0 && p.mass_kg <= kLargest))
    return refusal("mass_kg", fmt::format("{}", p.mass_kg), "a number in (0, 1e9]");
  if (!within(p.weight_n, 0.0))
    return refusal("weight_n", fmt::format("{}", p.weight_n), "a number in [0, 1e9]");
  if (!within(p.buoyancy_n, 0.0))
    return refusal("buoyancy_n", fmt::format("{}", p.buoyancy_n), "a number in [0, 1e9]");
  if (!is_finite_within(p.gravity_centre_m, 100.0) || !is_finite_within(p.buoyancy_centre_m, 100.0))
    return refusal(
        is_finite_within(p.gravity_centre_m, 100.0) ? "buoyancy_centre_m" : "gravity_centre_m",
        "another point", "one within 100 m of the body's origin");
  return {};
}

Status check_matrices(const VehicleParameters& p, const Mat6& rigid, const Mat6& mass) {
  if (!is_finite(rigid) || !(smallest_pivot(rigid) > kSingular))
    return refusal(
        "inertia_kg_m2",
        fmt::format("a mass matrix that is not positive definite, with mass {} and centre of "
                    "gravity ({}, {}, {})",
                    p.mass_kg, p.gravity_centre_m.x, p.gravity_centre_m.y, p.gravity_centre_m.z),
        "a positive definite one");
  if (!is_finite(mass) || !(smallest_pivot(symmetric_part(mass)) > kSingular))
    return refusal("added_mass",
                   "a sum with the rigid body's mass matrix that is not positive definite",
                   "a positive definite one");
  for (std::size_t i = 0; i < 6; ++i) {
    if (!within(p.added_mass(i, i), 0.0))
      return refusal("added_mass", fmt::format("{} on its diagonal", p.added_mass(i, i)),
                     "a number in [0, 1e9]");
    if (!within(p.linear_damping(i, i), 0.0))
      return refusal("linear_damping", fmt::format("{} on its diagonal", p.linear_damping(i, i)),
                     "a number in [0, 1e9]");
    if (!within(p.quadratic_damping[i], 0.0))
      return refusal("quadratic_damping", fmt::format("{}", p.quadratic_damping[i]),
                     "a number in [0, 1e9]");
  }
  if (!is_finite(p.linear_damping))
    return refusal("linear_damping", "a number that is not finite", "finite numbers");
  return {};
}

Status check_thrusters(const std::vector<Thruster>& thrusters) {
  if (thrusters.size() > kMaxThrusters)
    return refusal("thrusters", fmt::format("{}", thrusters.size()),
                   fmt::format("up to {}", kMaxThrusters));
  for (std::size_t i = 0; i < thrusters.size(); ++i) {
    const Thruster& t = thrusters[i];
    if (!is_finite_within(t.position_m, 100.0))
      return refusal(fmt::format("thrusters[{}].position_m", i), "another point",
                     "one within 100 m");
    if (!is_finite_within(t.direction, 2.0) || glm::length(t.direction) < 0.5)
      return refusal(fmt::format("thrusters[{}].direction", i),
                     fmt::format("({}, {}, {})", t.direction.x, t.direction.y, t.direction.z),
                     "a unit vector");
    if (!(t.min_n <= 0.0 && t.max_n >= 0.0 && t.min_n >= -kLargest && t.max_n <= kLargest))
      return refusal(fmt::format("thrusters[{}]", i),
                     fmt::format("forces from {} to {} N", t.min_n, t.max_n),
                     "from [-1e9, 0] to [0, 1e9]");
    if (!(t.propeller_m >= 0.0 && t.propeller_m <= kLargestPropeller_m))
      return refusal(fmt::format("thrusters[{}].propeller_m", i), fmt::format("{}", t.propeller_m),
                     fmt::format("[0, {}]", kLargestPropeller_m));
  }
  return {};
}

void prepare_rates(Vehicle& v) {
  const Mat6 damping = v.inverse_mass * v.linear_damping;
  for (std::size_t i = 0; i < 6; ++i) {  // the largest row sum bounds every eigenvalue
    double sum = 0.0;
    for (std::size_t j = 0; j < 6; ++j) sum += std::abs(damping(i, j));
    v.damping_rate = std::max(v.damping_rate, sum);
  }
  for (std::size_t j = 0; j < 6; ++j)
    for (std::size_t i = 0; i < 6; ++i)
      v.quadratic_rate[j] = std::max(v.quadratic_rate[j],
                                     2.0 * std::abs(v.inverse_mass(i, j)) * v.quadratic_damping[j]);
  const auto diagonal_range = [&](std::size_t first) {
    const Mat6& m = v.mass;
    return std::minmax({m(first, first), m(first + 1, first + 1), m(first + 2, first + 2)});
  };
  const auto [least_mass, most_mass] = diagonal_range(0);
  const double least_inertia = diagonal_range(3).first;
  v.righting_rate = std::sqrt((v.weight_n * glm::length(v.gravity_centre_m) +
                               v.buoyancy_n * glm::length(v.buoyancy_centre_m)) /
                              least_inertia);
  v.munk_rate = std::sqrt((most_mass - least_mass) / least_inertia);
  if (!v.tether) return;
  const double arm = glm::length(v.tether->attachment_m);
  const double inverse = 1.0 / least_mass + arm * arm / least_inertia;
  v.tether_rate = std::sqrt(v.tether->stiffness_n / v.tether->length_m * inverse) +
                  v.tether->damping_n_s / v.tether->length_m * inverse;
}

}  // namespace

Mat6 rigid_mass_matrix(double mass_kg, const Vec3& r_g, const Mat3& inertia) {
  Mat6 m;
  for (std::size_t i = 0; i < 3; ++i) m(i, i) = mass_kg;
  set_cross(m, 0, 3, r_g, -mass_kg);
  set_cross(m, 3, 0, r_g, mass_kg);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(3 + i, 3 + j) = inertia[j][i];
  return m;
}

Result<Vehicle> make_vehicle(const VehicleParameters& p) {
  NERITIC_TRY_STATUS(check_scalars(p));
  Vehicle v;
  v.mass_kg = p.mass_kg;
  v.weight_n = p.weight_n;
  v.buoyancy_n = p.buoyancy_n;
  v.displaced_kg = p.weight_n > 0.0 ? p.mass_kg * (p.buoyancy_n / p.weight_n) : p.mass_kg;
  v.gravity_centre_m = p.gravity_centre_m;
  v.buoyancy_centre_m = p.buoyancy_centre_m;
  v.rigid_mass = rigid_mass_matrix(p.mass_kg, p.gravity_centre_m, p.inertia_kg_m2);
  v.mass = v.rigid_mass + p.added_mass;
  NERITIC_TRY_STATUS(check_matrices(p, v.rigid_mass, v.mass));
  NERITIC_TRY_STATUS(check_thrusters(p.thrusters));
  NERITIC_TRY_STATUS(check_lag(p.lag));
  if (p.tether) NERITIC_TRY_STATUS(check_tether(*p.tether));
  if (p.battery) NERITIC_TRY_STATUS(check_battery(*p.battery));
  v.inverse_mass = inverse(v.mass);
  v.linear_damping = p.linear_damping;
  v.quadratic_damping = p.quadratic_damping;
  v.thruster_count = static_cast<std::uint32_t>(p.thrusters.size());
  for (std::size_t i = 0; i < p.thrusters.size(); ++i) {
    const Thruster& t = p.thrusters[i];
    v.thrusters[i] = t;
    v.thruster_wrench[i] = vec6(t.direction, glm::cross(t.position_m, t.direction));
    v.ventilates_m = std::max(v.ventilates_m,
                              glm::length(t.position_m) + kVentilatedRadii * 0.5 * t.propeller_m);
  }
  v.lag = p.lag;
  v.tether = p.tether;
  prepare_rates(v);
  return v;
}

void prepare_steps(Vehicle& vehicle, std::span<const double> steps_s) {
  // A step is whole, or of substeps of two halves each.
  constexpr int kSubsteps = 4;
  std::size_t next = 0;
  vehicle.prepared = {};
  const auto add = [&](double h_s) {
    if (next < kMaxPrepared) vehicle.prepared[next++] = LagPropagator(vehicle.lag, h_s);
  };
  for (const double step_s : steps_s) {
    add(step_s);
    for (int count = 1; count <= kSubsteps; ++count) add(0.5 * (step_s / count));
  }
}

LagPropagator propagator(const Vehicle& vehicle, double h_s) {
  for (const LagPropagator& prepared : vehicle.prepared)
    if (prepared.h_s() == h_s) return prepared;
  return {vehicle.lag, h_s};
}

}  // namespace neritic::rov
