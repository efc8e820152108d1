#include "testbed/envs/env_vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "rov/step.hpp"

namespace neritic::testbed {
namespace {

constexpr double kWater_kg_m3 = 1028.0;  // a scene's, unless it says otherwise

// A substep's length that `python3 -m neritic.tradeoff` finds accurate, and the longest: at 1.5 m/s
// the drag of a BlueROV2 changes by 22 a second, and RK4 is stable up to 2.8 / 22 s.
constexpr double kSubstep_s = 0.04, kMostSubstep_s = 0.1;

rov::Vec6 largest_wrench(const rov::Allocator& allocator) {
  rov::Vec6 out;
  for (std::size_t i = 0; i < 6; ++i) {
    rov::Vec6 axis;
    axis[i] = 1.0;
    out[i] = allocator.largest(axis);
    if (out[i] >= 1e6) out[i] = 0.0;  // thrusters have no such axis, or no limit
  }
  return out;
}

}  // namespace

Result<EnvMethod::Kind> env_method_of(std::string_view name) {
  if (name == "split") return EnvMethod::Kind::kSplit;
  if (name == "guarded") return EnvMethod::Kind::kGuarded;
  return refusal("method", fmt::format("'{}'", name), "split, guarded");
}

EnvModel::EnvModel(rov::VehicleFile file, rov::Vehicle vehicle, double step_s,
                   const EnvMethod& method)
    : file_(std::move(file)),
      vehicle_(std::move(vehicle)),
      allocator_(vehicle_),
      most_wrench_(largest_wrench(allocator_)),
      step_s_(step_s),
      method_(method) {
  for (std::size_t i = 0; i < vehicle_.thruster_count; ++i)
    limits_n_.push_back(method.thrust_table
                            ? rov::thruster_limits_n(file_, i)
                            : std::pair(vehicle_.thrusters[i].min_n, vehicle_.thrusters[i].max_n));
  // prepare_steps() knows up to four substeps; here there is one number of them.
  vehicle_.prepared = {};
  vehicle_.prepared[0] = rov::LagPropagator(vehicle_.lag, 0.5 * (step_s / method.substeps));
  if (file_.curve && method.thrust_table) {
    constexpr int kFirst_us = 1000, kLast_us = 2000;
    for (int us = kFirst_us; us <= kLast_us; ++us)
      thrust_by_us_.push_back(file_.curve->thrust_n(us, file_.voltage_v));
    constexpr int kBuckets = 1024;
    bucket_n_ = (thrust_by_us_.back() - thrust_by_us_.front()) / kBuckets;
    for (int i = 0; i <= kBuckets + 1; ++i) {
      // A bucket earlier, so that a rounded quotient never begins too late.
      const double from_n = thrust_by_us_.front() + (i - 1) * bucket_n_;
      first_at_.push_back(static_cast<std::uint32_t>(
          std::ranges::lower_bound(thrust_by_us_, from_n) - thrust_by_us_.begin()));
    }
  }
}

Result<std::unique_ptr<const EnvModel>> EnvModel::read(const std::filesystem::path& path,
                                                       double step_s, EnvMethod method) {
  if (!(step_s >= 1e-3 && step_s <= 1.0))
    return refusal("step_s", fmt::format("{}", step_s), "0.001 to 1 s");
  constexpr double kSlack = 1e-9;
  const auto least = [&](double most_s) {
    return static_cast<int>(std::ceil(step_s / most_s * (1.0 - kSlack)));
  };
  const bool split = method.kind == EnvMethod::Kind::kSplit;
  if (method.substeps == 0) method.substeps = split ? least(kSubstep_s) : 1;
  if (method.substeps < 0 || method.substeps > 1000)
    return refusal("substeps", fmt::format("{}", method.substeps), "1 to 1000");
  if (split && method.substeps < least(kMostSubstep_s))
    return refusal("substeps", fmt::format("{} in a step of {} s", method.substeps, step_s),
                   fmt::format("{} or more, so that none is longer than {} s",
                               least(kMostSubstep_s), kMostSubstep_s));
  NERITIC_TRY(rov::VehicleFile file, rov::read_vehicle(path, kWater_kg_m3));
  if (file.parameters.thrusters.empty())
    return refusal(path.string(), "a vehicle without thrusters", "one with thrusters");
  // It moves in open water: a tether would need its other end.
  file.parameters.tether.reset();
  NERITIC_TRY(rov::Vehicle vehicle, rov::make_vehicle(file.parameters));
  return std::unique_ptr<const EnvModel>(
      new EnvModel(std::move(file), std::move(vehicle), step_s, method));
}

// As ThrustCurve::realised_n: between two whole microseconds the nearer one, in the dead band none.
double EnvModel::realised_n(double command_n) const {
  if (thrust_by_us_.empty() || command_n == 0.0) return command_n;
  if (!(command_n > thrust_by_us_.front())) return thrust_by_us_.front();
  if (command_n >= thrust_by_us_.back()) return thrust_by_us_.back();
  std::size_t above =
      first_at_[static_cast<std::size_t>((command_n - thrust_by_us_.front()) / bucket_n_)];
  while (thrust_by_us_[above] < command_n) ++above;
  const double high = thrust_by_us_[above], low = thrust_by_us_[above - 1];
  return high - command_n <= command_n - low ? high : low;
}

void EnvVehicle::begin(const EnvModel& model, const Randomisation& random, const Dice& dice,
                       const Vec3& position_ned_m, const Quat& attitude) {
  vehicle = model.vehicle();
  const double mass = dice.factor(0, random.mass);
  if (random.mass > 0.0 || random.net_buoyancy_n > 0.0) {
    rov::VehicleParameters p = model.file().parameters;
    p.mass_kg *= mass;
    p.inertia_kg_m2 *= mass;
    p.weight_n *= mass;
    p.buoyancy_n =
        p.buoyancy_n * mass + dice.between(1, -random.net_buoyancy_n, random.net_buoyancy_n);
    // For parameters that are good with every mass: this cannot fail.
    rov::Vehicle made = rov::make_vehicle(p).value();
    made.prepared = vehicle.prepared;
    vehicle = std::move(made);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const double linear = dice.factor(2 + i, random.drag);
    for (std::size_t j = 0; j < 6; ++j)
      if (i == j) vehicle.linear_damping(i, j) *= linear;
    vehicle.quadratic_damping[i] *= dice.factor(8 + i, random.drag);
  }
  for (std::size_t i = 0; i < rov::kMaxThrusters; ++i)
    thrust_factor[i] = dice.factor(14 + i, random.thrust);
  const double current_m_s = dice.between(30, 0.0, random.current_m_s),
               from_rad = dice.between(31, 0.0, 2.0 * kPi);
  inputs = {};
  inputs.current_ned_m_s = {current_m_s * std::cos(from_rad), current_m_s * std::sin(from_rad),
                            0.0};
  motion = {position_ned_m, attitude, rov::through_water(attitude, {}, inputs.current_ned_m_s),
            inputs.current_ned_m_s};
  lag = {};
}

void EnvVehicle::step(const EnvModel& model, std::span<const double> command_n) {
  for (std::size_t i = 0; i < command_n.size(); ++i)
    inputs.thruster_n[i] = thrust_factor[i] * model.realised_n(command_n[i]);
  const EnvMethod& method = model.method();
  if (method.kind == EnvMethod::Kind::kSplit) {
    rov::split_rk4({vehicle, inputs, {}, model.step_s()}, method.substeps, motion, lag);
    return;
  }
  rov::State state{.position_ned_m = motion.position_ned_m,
                   .attitude = motion.attitude,
                   .velocity = velocity(),
                   .lag = lag};
  for (int i = 0; i < method.substeps; ++i)
    state = rov::step(vehicle, state, inputs, model.step_s() / method.substeps);
  motion = {state.position_ned_m, state.attitude,
            rov::through_water(state.attitude, state.velocity, inputs.current_ned_m_s),
            inputs.current_ned_m_s};
  lag = state.lag;
}

}  // namespace neritic::testbed
