#include "rov/closed_loop.hpp"

#include <algorithm>

#include "rov/thrust_priority.hpp"

namespace neritic::rov {

LoopRun fly(const Vehicle& vehicle, const ControlGains& gains, const State& start,
            const Guide& guide, double seconds, const LoopSteps& steps) {
  const Allocator allocator(vehicle);
  const auto periods = static_cast<std::size_t>(std::llround(seconds / gains.period_s));
  LoopRun run;
  run.period_s = gains.period_s;
  run.states.reserve(periods + 1);
  run.states.push_back(start);
  State state = start;
  ControlState control;
  for (std::size_t k = 0; k < periods; ++k) {
    const Setpoint setpoint = guide(state, static_cast<double>(k) * gains.period_s);
    const Inputs inputs = (steps.level_first ? level_inputs : control_inputs)(
        vehicle, allocator, gains, setpoint, state, control);
    for (int i = 0; i < steps.count; ++i)
      state = step(vehicle, state, inputs, gains.period_s / steps.count, steps.integrator);
    for (const double force : inputs.thruster_n)
      run.largest_thruster_n = std::max(run.largest_thruster_n, std::abs(force));
    const Quat& q = state.attitude;
    const double upright = std::clamp(1.0 - 2.0 * (q.x * q.x + q.y * q.y), -1.0, 1.0);
    run.largest_tilt_rad = std::max(run.largest_tilt_rad, std::acos(upright));
    run.states.push_back(state);
  }
  return run;
}

StepResponse step_response(const std::vector<double>& values, double period_s) {
  StepResponse out;
  if (values.empty()) return out;
  const auto first_at = [&](double level) {
    const auto at = std::ranges::find_if(values, [&](double v) { return v >= level; });
    return period_s * static_cast<double>(at - values.begin());
  };
  out.t90_s = first_at(0.9);
  out.rise_10_90_s = out.t90_s - first_at(0.1);
  out.overshoot = std::max(0.0, *std::ranges::max_element(values) - 1.0);
  std::size_t settled = values.size();
  while (settled > 0 && std::abs(values[settled - 1] - 1.0) <= 0.05) --settled;
  out.settled_s = period_s * static_cast<double>(settled);
  out.final_error = values.back() - 1.0;
  return out;
}

}  // namespace neritic::rov
