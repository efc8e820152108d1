#include "rov/step.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "rov/integrators.hpp"

namespace neritic::rov {
namespace {

constexpr double kMostDistance = 1e9;  // m
constexpr double kLongestStep = 10.0;  // s

// Rate times substep at which RK4 errs by about 1e-6 of a motion (measured by `tradeoff physics`);
// the lag is exact and only has to be sampled.
constexpr double kGuard = 0.25;
constexpr double kLagGuard = 0.7;
// More RK4 substeps than this cost more than a simulation at 240 Hz in all; semi-implicit ones are
// stable at any length, so that fewer do.
constexpr int kMostSubsteps = 512;
constexpr int kImplicitSubsteps = 64;

constexpr std::string_view kNames[] = {"semi_euler", "rk4", "guarded"};

bool good(const Vec6& v) {
  return std::ranges::all_of(v.v, [](double x) { return std::abs(x) <= kMostForce; });
}
bool good(const Vec3& v, double most) {
  return std::abs(v.x) <= most && std::abs(v.y) <= most && std::abs(v.z) <= most;
}

// value into held where it is good, else one refusal more. NaN fails every comparison.
template <class T>
void take(bool is_good, const T& value, T& held, std::uint64_t& refused) {
  if (is_good)
    held = value;
  else
    ++refused;
}

void take_inputs(const Inputs& in, State& state) {
  Inputs& held = state.held;
  std::uint64_t& refused = state.refused_inputs;
  take(good(in.wrench), in.wrench, held.wrench, refused);
  for (std::size_t i = 0; i < kMaxThrusters; ++i)
    take(std::abs(in.thruster_n[i]) <= kMostForce, in.thruster_n[i], held.thruster_n[i], refused);
  take(good(in.current_ned_m_s, kMostCurrent_m_s), in.current_ned_m_s, held.current_ned_m_s,
       refused);
  for (const auto acceleration :
       {&Inputs::current_change_ned_m_s2, &Inputs::water_acceleration_ned_m_s2})
    take(good(in.*acceleration, kMostWaterAcceleration_m_s2), in.*acceleration, held.*acceleration,
         refused);
  take(good(in.tether_anchor_ned_m, kMostDistance), in.tether_anchor_ned_m,
       held.tether_anchor_ned_m, refused);
  held.failed_thrusters = in.failed_thrusters;
}

bool is_sane(const Quat& q) {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}
bool is_sane(const WaterMotion& m) {
  return is_finite(m.position_ned_m) && is_sane(m.attitude) && is_finite(m.velocity);
}

WaterMotion motion_of(const State& state) {
  return {state.position_ned_m, state.attitude,
          through_water(state.attitude, state.velocity, state.held.current_ned_m_s),
          state.held.current_ned_m_s};
}

int substeps_for(const StepTask& task, const State& state) {
  const WaterMotion motion = motion_of(state);
  const Vec6 thrust =
      thruster_wrench(task.vehicle, thruster_forces(task.vehicle, state, task.inputs));
  const WaterMotion rate =
      motion_rate(task.vehicle, motion, task.wrench_at(0.0) + thrust, task.inputs);
  const double wanted = std::max(change_rate(task.vehicle, motion, rate) * task.dt_s / kGuard,
                                 0.5 * task.vehicle.lag.fastest * task.dt_s / kLagGuard);
  if (!(wanted <= kMostSubsteps)) return 0;
  return std::max(1, static_cast<int>(std::ceil(wanted)));
}

void guarded(const StepTask& task, const State& state, WaterMotion& motion, LagStates& lag) {
  if (const int substeps = substeps_for(task, state); substeps > 0) {
    split_rk4(task, substeps, motion, lag);
    if (is_sane(motion)) return;
    motion = motion_of(state);
    lag = state.lag;
  }
  // Weight and buoyancy are explicit there: their period bounds the substep.
  const double wanted = task.dt_s * (task.vehicle.righting_rate + task.vehicle.tether_rate);
  semi_implicit(task, std::clamp(static_cast<int>(wanted), kImplicitSubsteps, 4096), true, motion,
                lag);
}

}  // namespace

std::string_view name_of(Integrator integrator) {
  return kNames[static_cast<std::size_t>(integrator)];
}

Result<Integrator> integrator_of(std::string_view name) {
  for (std::size_t i = 0; i < std::size(kNames); ++i)
    if (kNames[i] == name) return static_cast<Integrator>(i);
  return refusal("", fmt::format("integrator '{}'", name), "semi_euler, rk4 or guarded");
}

State step(const Vehicle& vehicle, const State& state, const Inputs& inputs, double dt_s,
           Integrator integrator, const VaryingWrench& varying) {
  State next = state;
  take_inputs(inputs, next);
  if (!(dt_s > 0.0 && dt_s <= kLongestStep)) {
    ++next.refused_inputs;
    return next;
  }
  const StepTask task{vehicle, next.held, varying, dt_s};
  WaterMotion motion = motion_of(next);
  LagStates lag = next.lag;
  switch (integrator) {
    case Integrator::kSemiImplicit:
      semi_implicit(task, 1, false, motion, lag);
      break;
    case Integrator::kRk4:
      rk4(task, motion, lag);
      break;
    case Integrator::kGuarded:
      guarded(task, next, motion, lag);
      break;
  }
  if (!is_sane(motion)) return next;
  next.position_ned_m = motion.position_ned_m;
  next.attitude = motion.attitude;
  next.velocity = over_ground(motion.attitude, motion.velocity, motion.current_ned_m_s);
  next.lag = lag;
  return next;
}

int guarded_substeps(const Vehicle& vehicle, const State& state, const Inputs& inputs,
                     double dt_s) {
  State now = state;
  take_inputs(inputs, now);
  return substeps_for({vehicle, now.held, {}, dt_s}, now);
}

bool teleport(State& state, const Vec3& position_ned_m, const Quat& attitude) {
  const double length = glm::length(attitude);
  if (!good(position_ned_m, kMostDistance) || !is_sane(attitude) || !(length > 0.0)) return false;
  state.position_ned_m = position_ned_m;
  state.attitude = attitude / length;
  state.velocity = {};
  state.lag = {};
  return true;
}

}  // namespace neritic::rov
