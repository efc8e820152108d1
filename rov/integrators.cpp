#include "rov/integrators.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::rov {
namespace {

// a + h * rate; the attitude is a sum, not of unit length.
WaterMotion moved(const WaterMotion& a, double h, const WaterMotion& rate) {
  return {a.position_ned_m + h * rate.position_ned_m, a.attitude + h * rate.attitude,
          a.velocity + h * rate.velocity, a.current_ned_m_s + h * rate.current_ned_m_s};
}

// (k1 + 2 k2 + 2 k3 + k4) / 6
WaterMotion mean(const WaterMotion& k1, const WaterMotion& k2, const WaterMotion& k3,
                 const WaterMotion& k4) {
  WaterMotion sum = moved(k1, 2.0, k2);
  sum = moved(sum, 2.0, k3);
  sum = moved(sum, 1.0, k4);
  return {sum.position_ned_m / 6.0, sum.attitude / 6.0, (1.0 / 6.0) * sum.velocity,
          sum.current_ned_m_s / 6.0};
}

// The wrench of all thrusters with this memory.
Vec6 thrust(const StepTask& task, const LagStates& lag) {
  std::array<double, kMaxThrusters> forces{};
  for (std::size_t i = 0; i < task.vehicle.thruster_count; ++i)
    forces[i] = force_of(task.vehicle.lag, lag[i], followed_command(task.vehicle, task.inputs, i));
  return thruster_wrench(task.vehicle, forces);
}

void advance(const StepTask& task, const LagPropagator& by, LagStates& lag) {
  for (std::size_t i = 0; i < task.vehicle.thruster_count; ++i)
    lag[i] = by.advance(lag[i], followed_command(task.vehicle, task.inputs, i));
}

// Advances the lag over h and returns M^-1 times the impulse that the thrusters gave.
Vec6 thrust_half(const StepTask& task, const LagPropagator& by, double h, LagStates& lag) {
  std::array<double, kMaxThrusters> impulses{};
  for (std::size_t i = 0; i < task.vehicle.thruster_count; ++i) {
    const double command = followed_command(task.vehicle, task.inputs, i);
    const LagState before = lag[i];
    lag[i] = by.advance(before, command);
    impulses[i] = impulse_of(task.vehicle.lag, before, lag[i], command, h);
  }
  return task.vehicle.inverse_mass * thruster_wrench(task.vehicle, impulses);
}

// C(nu) as a matrix that is skew-symmetric for any nu (Fossen 2011, eq. 3.46): its power is 0.
Mat6 coriolis_matrix(const Vehicle& vehicle, const Vec6& nu) {
  const Vec6 momentum = vehicle.mass * nu;
  Mat6 c;
  set_cross(c, 0, 3, momentum.linear(), -1.0);
  set_cross(c, 3, 0, momentum.linear(), -1.0);
  set_cross(c, 3, 3, momentum.angular(), -1.0);
  return c;
}

// The x with a x + b |x| x = c, a > 0, b >= 0.
double solve_drag(double a, double b, double c) {
  const double root = std::sqrt(a * a + 4.0 * b * std::abs(c));
  return 2.0 * c / (a + root);
}

// nu1 of M (nu1 - nu0) = h (wrench - C(nu0) nu - D_L nu1 - D_Q |nu1| nu1), nu being nu0 or, where
// Coriolis terms are implicit too, nu1; by Newton's method from each axis' own solution. The
// operator is monotone, so there is one solution; with nu1, since C is skew and D positive, no step
// length makes 1/2 nu1^T M nu1 exceed what the wrench gave.
Vec6 implicit_velocity(const Vehicle& v, const Vec6& nu0, const Vec6& wrench, double h,
                       bool implicit_coriolis) {
  const Mat6 coriolis = coriolis_matrix(v, nu0);
  Mat6 linear = v.mass + h * v.linear_damping;
  Vec6 target = v.mass * nu0 + h * wrench;
  if (implicit_coriolis)
    linear = linear + h * coriolis;
  else
    target = target - h * (coriolis * nu0);
  Vec6 nu;
  for (std::size_t i = 0; i < 6; ++i)
    nu[i] = solve_drag(linear(i, i), h * v.quadratic_damping[i], target[i]);
  for (int iteration = 0; iteration < 25; ++iteration) {
    Vec6 residual = linear * nu - target;
    Mat6 slope = linear;
    for (std::size_t i = 0; i < 6; ++i) {
      residual[i] += h * v.quadratic_damping[i] * std::abs(nu[i]) * nu[i];
      slope(i, i) += 2.0 * h * v.quadratic_damping[i] * std::abs(nu[i]);
    }
    Vec6 change;
    if (!solve(slope, residual, change)) break;
    nu = nu - change;
    double largest = 0.0, size = 0.0;
    for (std::size_t i = 0; i < 6; ++i) {
      largest = std::max(largest, std::abs(change[i]));
      size = std::max(size, std::abs(nu[i]));
    }
    if (largest <= 1e-14 * size) break;
  }
  return nu;
}

// q (x) exp(h w / 2).
Quat turned(const Quat& q, const Vec3& w, double h) {
  const double angle = h * glm::length(w);
  if (angle == 0.0) return q;
  return q * glm::angleAxis(angle, w / glm::length(w));
}

}  // namespace

void normalise(Quat& q) {
  q = q / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
}

double change_rate(const Vehicle& v, const WaterMotion& motion, const WaterMotion& rate) {
  const Vec6 &nu = motion.velocity, &acceleration = rate.velocity;
  double drag = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    // Now, and at the terminal velocity that the acceleration leads to: u' = a - k u^2 settles at
    // the rate 2 sqrt(k a).
    drag = std::max(drag, v.quadratic_rate[i] * std::abs(nu[i]));
    drag = std::max(drag, std::sqrt(2.0 * v.quadratic_rate[i] * std::abs(acceleration[i])));
  }
  return v.damping_rate + drag + v.righting_rate + v.tether_rate +
         v.munk_rate * glm::length(nu.linear()) + glm::length(nu.angular()) +
         std::sqrt(glm::length(acceleration.angular()));
}

void semi_implicit(const StepTask& task, int substeps, bool implicit_coriolis, WaterMotion& motion,
                   LagStates& lag) {
  const double h = task.dt_s / substeps;
  const LagPropagator whole = propagator(task.vehicle, h);
  for (int i = 0; i < substeps; ++i) {
    advance(task, whole, lag);
    const Vec6 wrench = task.wrench_at((i + 1) * h) + thrust(task, lag) +
                        static_wrench(task.vehicle, motion, task.inputs) +
                        water_wrench(task.vehicle, motion.attitude, task.inputs);
    motion.velocity =
        implicit_velocity(task.vehicle, motion.velocity, wrench, h, implicit_coriolis);
    motion.current_ned_m_s += h * task.inputs.current_change_ned_m_s2;
    motion.position_ned_m +=
        h * (motion.attitude * motion.velocity.linear() + motion.current_ned_m_s);
    motion.attitude = turned(motion.attitude, motion.velocity.angular(), h);
    normalise(motion.attitude);
  }
}

void rk4(const StepTask& task, WaterMotion& motion, LagStates& lag) {
  const double h = task.dt_s;
  const std::size_t count = task.vehicle.thruster_count;
  const auto rate = [&](double t, const WaterMotion& m, const LagStates& l) {
    return motion_rate(task.vehicle, m, task.wrench_at(t) + thrust(task, l), task.inputs);
  };
  const auto lag_rates = [&](const LagStates& l) {
    LagStates out{};
    for (std::size_t i = 0; i < count; ++i)
      out[i] = lag_rate(task.vehicle.lag, l[i], followed_command(task.vehicle, task.inputs, i));
    return out;
  };
  const auto lag_moved = [&](const LagStates& from, double by, const LagStates& rates) {
    LagStates out = from;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < 3; ++k) out[i][k] += by * rates[i][k];
    return out;
  };
  const WaterMotion k1 = rate(0.0, motion, lag);
  const LagStates l1 = lag_rates(lag), lag2 = lag_moved(lag, 0.5 * h, l1);
  const WaterMotion k2 = rate(0.5 * h, moved(motion, 0.5 * h, k1), lag2);
  const LagStates l2 = lag_rates(lag2), lag3 = lag_moved(lag, 0.5 * h, l2);
  const WaterMotion k3 = rate(0.5 * h, moved(motion, 0.5 * h, k2), lag3);
  const LagStates l3 = lag_rates(lag3), lag4 = lag_moved(lag, h, l3);
  const WaterMotion k4 = rate(h, moved(motion, h, k3), lag4);
  motion = moved(motion, h, mean(k1, k2, k3, k4));
  normalise(motion.attitude);
  const LagStates l4 = lag_rates(lag4);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      lag[i][k] += h / 6.0 * (l1[i][k] + 2.0 * l2[i][k] + 2.0 * l3[i][k] + l4[i][k]);
}

void split_rk4(const StepTask& task, int substeps, WaterMotion& motion, LagStates& lag) {
  const double h = task.dt_s / substeps;
  const LagPropagator half = propagator(task.vehicle, 0.5 * h);
  const auto rate = [&](double at, const WaterMotion& m) {
    return motion_rate(task.vehicle, m, task.wrench_at(at), task.inputs);
  };
  const auto pushed = [](WaterMotion m, const Vec6& by) {
    m.velocity = m.velocity + by;
    return m;
  };
  for (int i = 0; i < substeps; ++i) {
    const double t = i * h;
    // Changes of velocity by the thrusters alone.
    const Vec6 by_middle = thrust_half(task, half, 0.5 * h, lag);
    const Vec6 by_end = by_middle + thrust_half(task, half, 0.5 * h, lag);
    const WaterMotion k1 = rate(t, motion);
    const WaterMotion k2 = rate(t + 0.5 * h, pushed(moved(motion, 0.5 * h, k1), by_middle));
    const WaterMotion k3 = rate(t + 0.5 * h, pushed(moved(motion, 0.5 * h, k2), by_middle));
    const WaterMotion k4 = rate(t + h, pushed(moved(motion, h, k3), by_end));
    motion = pushed(moved(motion, h, mean(k1, k2, k3, k4)), by_end);
    normalise(motion.attitude);
  }
}

}  // namespace neritic::rov
