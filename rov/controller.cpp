#include "rov/controller.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::rov {
namespace {

// Roll and pitch left as they are, at another heading.
Quat with_heading(const Quat& attitude, double heading_rad) {
  return heading_attitude(heading_rad - heading_of(attitude)) * attitude;
}

// u of all axes.
Vec6 corrections(const ControlGains& gains, const Vec6& error, const Vec6& rate,
                 ControlState& control, Clip clip) {
  std::array<PidTerms, 6> terms;
  for (std::size_t i = 0; i < 6; ++i)
    terms[i] = pid_terms(gains.axes[i], control.integral[i], error[i], rate[i], gains.period_s);
  const auto excess = [&](std::size_t i) {
    return std::abs(terms[i].pull) / std::max(gains.axes[i].u_max, 1e-300);
  };
  std::size_t most = 0;
  for (const std::size_t i : {1, 2})
    if (excess(i) > excess(most)) most = i;
  double share = 1.0;
  if (const auto& [pull, rest] = terms[most]; clip == Clip::kDirection && pull != 0.0)
    share = std::clamp((std::copysign(gains.axes[most].u_max, pull) - rest) / pull, 0.0, 1.0);
  Vec6 u;
  for (std::size_t i = 0; i < 6; ++i)
    u[i] = std::clamp((i < 3 ? share : 1.0) * terms[i].pull + terms[i].rest, -gains.axes[i].u_max,
                      gains.axes[i].u_max);
  return u;
}

// The held components of a world vector.
Vec3 held(const Setpoint& s, const Vec3& v) {
  return {s.hold_north ? v.x : 0.0, s.hold_east ? v.y : 0.0, s.hold_depth ? v.z : 0.0};
}

}  // namespace

ControlGains default_gains() {
  ControlGains gains;
  for (std::size_t i = 0; i < 6; ++i) {
    PidAxis& axis = gains.axes[i];
    const bool linear = i < 3, heave = i == 2, yaw = i == 5;
    axis.kp = linear ? (heave ? 10.0 : 8.0) : (yaw ? 12.0 : 30.0);
    axis.ki = linear ? (heave ? 1.2 : 0.8) : (yaw ? 0.6 : 2.0);
    axis.kd = linear ? (heave ? 5.0 : 4.0) : (yaw ? 5.0 : 7.0);
    axis.u_max = linear ? (heave ? 11.0 : 9.5) : 40.0;
    axis.i_max = linear || yaw ? 1.0 : 3.0;
    axis.zone = linear ? 0.15 : 0.3;
  }
  return gains;
}

Quat heading_attitude(double heading_rad) {
  return {std::cos(0.5 * heading_rad), 0.0, 0.0, std::sin(0.5 * heading_rad)};
}

Vec3 rotation_vector(Quat q) {
  if (q.w < 0.0) q = -q;
  const Vec3 v(q.x, q.y, q.z);
  const double n = glm::length(v);
  return n < 1e-12 ? 2.0 * v : 2.0 * std::atan2(n, q.w) / n * v;
}

double heading_of(const Quat& q) {
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
}

Vec3 along(const Vec3& vector) {
  const double length = glm::length(vector);
  return length > 0.0 ? vector / length : Vec3(0.0);
}

Vec6 drag_of(const Vehicle& vehicle, const Vec3& velocity_m_s) {
  const Vec6 moving = vec6(velocity_m_s, Vec3(0.0));
  Vec6 drag = vehicle.linear_damping * moving;
  for (std::size_t i = 0; i < 6; ++i)
    drag[i] += vehicle.quadratic_damping[i] * std::abs(moving[i]) * moving[i];
  return drag;
}

Vec6 pose_error(const Vec3& position, const Quat& attitude, const Vec3& wanted_position,
                const Quat& wanted_attitude) {
  const Quat back = glm::conjugate(attitude);
  return vec6(back * (wanted_position - position), rotation_vector(back * wanted_attitude));
}

Vec6 control_wrench(const Vehicle& vehicle, const ControlGains& gains, const Setpoint& s,
                    const State& state, ControlState& control, Clip clip) {
  const Quat& q = state.attitude;
  const Quat back = glm::conjugate(q);
  const bool all_position = s.hold_north && s.hold_east && s.hold_depth;
  // Axes that the setpoint leaves free follow the body.
  Quat wanted = s.attitude;
  if (!s.hold_level) wanted = with_heading(q, heading_of(s.hold_heading ? s.attitude : q));
  if (s.hold_level && !s.hold_heading) wanted = with_heading(s.attitude, heading_of(q));
  const Vec3 wanted_position =
      all_position ? s.position_ned_m
                   : state.position_ned_m + held(s, s.position_ned_m - state.position_ned_m);
  const Vec6 error = pose_error(state.position_ned_m, q, wanted_position, wanted);
  const Vec3 setpoint_velocity = back * held(s, s.velocity_ned_m_s);
  Vec6 rate = state.velocity - vec6(setpoint_velocity, Vec3(0.0));
  if (!all_position) {
    const Vec3 linear = back * held(s, q * state.velocity.linear()) - setpoint_velocity;
    for (int i = 0; i < 3; ++i) rate[static_cast<std::size_t>(i)] = linear[i];
  }
  if (!s.hold_heading) rate[5] = 0.0;
  if (!s.hold_level) rate[3] = rate[4] = 0.0;
  Vec6 u = corrections(gains, error, rate, control, clip);
  const Vec3 way = along(setpoint_velocity);
  if (s.by_drag_alone) u = u - vec6(glm::dot(u.linear(), way) * way, Vec3(0.0));
  Vec6 wrench = vehicle.rigid_mass * u + s.pilot;
  if (gains.feed_forward)
    wrench = wrench - static_wrench(vehicle,
                                    {state.position_ned_m, q,
                                     through_water(q, state.velocity, state.held.current_ned_m_s),
                                     state.held.current_ned_m_s},
                                    state.held);
  const Vec6 drag = drag_of(vehicle, setpoint_velocity);
  wrench = wrench + drag;
  if (s.by_drag_alone) {
    // Water from the side changes the drag along a way that is off the body's axes.
    const Vec3 flow = through_water(q, state.velocity, state.held.current_ned_m_s).linear();
    const Vec6 here = drag_of(vehicle, setpoint_velocity + flow - glm::dot(flow, way) * way);
    wrench = wrench + vec6(glm::dot((here - drag).linear(), way) * way, Vec3(0.0));
  }
  return wrench;
}

Inputs control_inputs(const Vehicle& vehicle, const Allocator& allocator, const ControlGains& gains,
                      const Setpoint& setpoint, const State& state, ControlState& control) {
  Inputs inputs = state.held;
  inputs.wrench = {};
  inputs.thruster_n =
      allocator.allocate(control_wrench(vehicle, gains, setpoint, state, control), gains.saturation)
          .force_n;
  return inputs;
}

Setpoint stay(const State& state) {
  Setpoint out;
  out.position_ned_m = state.position_ned_m;
  out.attitude = heading_attitude(heading_of(state.attitude));
  return out;
}

Setpoint depth_hold(const State& state, const Vec6& pilot) {
  Setpoint out = stay(state);
  out.hold_north = out.hold_east = out.hold_heading = false;
  out.pilot = pilot;
  return out;
}

Setpoint heading_hold(const State& state, const Vec6& pilot) {
  Setpoint out = stay(state);
  out.hold_north = out.hold_east = out.hold_depth = false;
  out.pilot = pilot;
  return out;
}

}  // namespace neritic::rov
