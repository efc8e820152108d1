// The controller's law on one axis, u = K_P e + I - K_D v, with clipping and anti-windup. Pure
// function; any thread.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace neritic::rov {

struct PidAxis {
  double kp = 0.0, ki = 0.0, kd = 0.0;
  double u_max = std::numeric_limits<double>::infinity();
  double i_max = std::numeric_limits<double>::infinity();
  // The integral advances only where |e| is within it.
  double zone = std::numeric_limits<double>::infinity();
};

// The output before it is clipped: what pulls to the setpoint, K_P e, and the rest, I - K_D v.
struct PidTerms {
  double pull = 0.0, rest = 0.0;
};

// One period dt_s. rate: how fast the axis moves (its error falls, where the setpoint stands
// still). The integral stays as it is where the output is clipped in the error's direction.
inline PidTerms pid_terms(const PidAxis& axis, double& integral, double error, double rate,
                          double dt_s) {
  const double advance = std::abs(error) <= axis.zone ? axis.ki * error * dt_s : 0.0;
  const double next = std::clamp(integral + advance, -axis.i_max, axis.i_max);
  const double raw = axis.kp * error + next - axis.kd * rate;
  const bool winds_up = std::abs(raw) > axis.u_max && (raw > 0.0) == (error > 0.0) && error != 0.0;
  if (!winds_up) integral = next;
  return {axis.kp * error, integral - axis.kd * rate};
}

// The same, clipped.
inline double pid_step(const PidAxis& axis, double& integral, double error, double rate,
                       double dt_s) {
  const PidTerms terms = pid_terms(axis, integral, error, rate, dt_s);
  return std::clamp(terms.pull + terms.rest, -axis.u_max, axis.u_max);
}

}  // namespace neritic::rov
