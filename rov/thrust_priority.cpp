#include "rov/thrust_priority.hpp"

#include <algorithm>

namespace neritic::rov {
namespace {

// The pole of the observer that learns the push that holds a speed, at most; and its share of the
// rate at which the thrusters follow, so that the loop keeps 45 degrees of phase at least.
constexpr double kFastestLearning_1_s = 8.0, kShareOfFollowing = 0.5;

// The time by which thrust comes late: the first moment of its lag's answer to an impulse.
double delay_s(const ThrusterLag& lag) {
  switch (lag.kind) {
    case ThrusterLag::Kind::kNone:
      return 0.0;
    case ThrusterLag::Kind::kFirstOrder:
      return lag.time_s;
    case ThrusterLag::Kind::kThirdOrder:
      return std::max(0.0, (lag.a1 - lag.b1) / lag.a0);
  }
  return 0.0;
}

double learning_1_s(const Vehicle& vehicle, const ControlGains& gains) {
  return std::min(kFastestLearning_1_s,
                  kShareOfFollowing / (delay_s(vehicle.lag) + gains.period_s));
}

// The direction of a setpoint's way, body axes; 0: it stands still.
Vec3 path_of(const Setpoint& setpoint, const State& state) {
  return along(glm::conjugate(state.attitude) * setpoint.velocity_ned_m_s);
}

// The push along the path on top of the controller's, for a setpoint whose speed is over ground.
// A disturbance observer (Ohnishi, Shibata, Murakami 1996, IEEE/ASME Trans. Mechatronics 1(1), eq.
// 6 to 8): with the control's own model of a vehicle that comes to its speed w from v,
//   m v' = D(w) - D(v) + K (w - v),
// what the vehicle's true m v' lacks is learnt by a filter of first order at the rate l,
//   e' = l (D(w) - D(v) + K (w - v) - m v' - f),  so that  e = s - l m v,
//   s' = l (D(w) - D(v) + K (w - v) - f),
// f: the push that the thrusters did not give (unlearn_push): none of it is learnt, so that a
// vehicle that could not keep up does not dash off when it can. m with the added mass, K = M_RB
// K_D; newtons along the path. A wrong model errs while the speed changes alone. control.speed_n is
// s.
double speed_push_n(const Vehicle& vehicle, const ControlGains& gains, const Setpoint& setpoint,
                    const State& state, ControlState& control) {
  const Vec3 path = path_of(setpoint, state);
  if (!setpoint.over_ground || path == Vec3(0.0)) {
    control.speed_n = 0.0;
    return 0.0;
  }
  const auto share = [&](const Vec6& wrench) { return glm::dot(wrench.linear(), path); };
  Vec3 damped = path;
  for (int i = 0; i < 3; ++i) damped[i] *= gains.axes[static_cast<std::size_t>(i)].kd;
  const double mass_kg = share(vehicle.mass * vec6(path, Vec3(0.0)));
  const double damping = share(vehicle.rigid_mass * vec6(damped, Vec3(0.0)));  // K, N s/m
  const double wanted_m_s = glm::length(setpoint.velocity_ned_m_s);
  const double now_m_s = glm::dot(state.velocity.linear(), path);
  const auto drag_n = [&](double speed_m_s) { return share(drag_of(vehicle, speed_m_s * path)); };
  const double rate_1_s = learning_1_s(vehicle, gains);
  const double moving_n = rate_1_s * mass_kg * now_m_s;
  if (control.speed_n == 0.0) control.speed_n = moving_n;  // begins with e = 0
  const double push_n = control.speed_n - moving_n;
  control.speed_n += rate_1_s * gains.period_s *
                     (drag_n(wanted_m_s) - drag_n(now_m_s) + damping * (wanted_m_s - now_m_s));
  return push_n;
}

}  // namespace

void unlearn_push(const Vehicle& vehicle, const ControlGains& gains, const Setpoint& setpoint,
                  const State& state, const Vec6& missing, ControlState& control) {
  if (!setpoint.over_ground) return;
  control.speed_n -= learning_1_s(vehicle, gains) * gains.period_s *
                     glm::dot(missing.linear(), path_of(setpoint, state));
}

WrenchParts parted_wrench(const Vehicle& vehicle, const ControlGains& gains,
                          const Setpoint& setpoint, const State& state, ControlState& control) {
  Setpoint unpiloted = setpoint;
  unpiloted.pilot = {};
  const Vec6 wrench = control_wrench(vehicle, gains, unpiloted, state, control, Clip::kDirection);
  const Vec3 munk = glm::cross(state.velocity.linear(), (vehicle.mass * state.velocity).linear());
  const Vec3 path = path_of(setpoint, state);
  const Vec3 push = glm::dot(wrench.linear(), path) * path;
  const double more_n = speed_push_n(vehicle, gains, setpoint, state, control);
  return {vec6(Vec3(0.0), wrench.angular() + munk), vec6(wrench.linear() - push, Vec3(0.0)),
          vec6(push + more_n * path, Vec3(0.0)) + setpoint.pilot};
}

Inputs level_inputs(const Vehicle& vehicle, const Allocator& allocator, const ControlGains& gains,
                    const Setpoint& setpoint, const State& state, ControlState& control) {
  const WrenchParts parts = parted_wrench(vehicle, gains, setpoint, state, control);
  Inputs inputs = state.held;
  inputs.wrench = {};
  inputs.thruster_n = {};
  double given = 1.0;  // of the push
  for (const Vec6& part : {parts.level, parts.hold, parts.push}) {
    const Allocation allocation = allocator.allocate(part, gains.saturation, inputs.thruster_n);
    inputs.thruster_n = allocation.force_n;
    given = allocation.scale;
  }
  unlearn_push(vehicle, gains, setpoint, state, (1.0 - given) * parts.push, control);
  return inputs;
}

}  // namespace neritic::rov
