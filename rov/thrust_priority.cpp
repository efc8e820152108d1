#include "rov/thrust_priority.hpp"

namespace neritic::rov {

WrenchParts parted_wrench(const Vehicle& vehicle, const ControlGains& gains,
                          const Setpoint& setpoint, const State& state, ControlState& control) {
  Setpoint unpiloted = setpoint;
  unpiloted.pilot = {};
  const Vec6 wrench = control_wrench(vehicle, gains, unpiloted, state, control, Clip::kDirection);
  const Vec3 munk = glm::cross(state.velocity.linear(), (vehicle.mass * state.velocity).linear());
  const Vec3 path = along(glm::conjugate(state.attitude) * setpoint.velocity_ned_m_s);
  const Vec3 push = glm::dot(wrench.linear(), path) * path;
  return {vec6(Vec3(0.0), wrench.angular() + munk), vec6(wrench.linear() - push, Vec3(0.0)),
          vec6(push, Vec3(0.0)) + setpoint.pilot};
}

Inputs level_inputs(const Vehicle& vehicle, const Allocator& allocator, const ControlGains& gains,
                    const Setpoint& setpoint, const State& state, ControlState& control) {
  const WrenchParts parts = parted_wrench(vehicle, gains, setpoint, state, control);
  Inputs inputs = state.held;
  inputs.wrench = {};
  inputs.thruster_n = {};
  for (const Vec6& part : {parts.level, parts.hold, parts.push})
    inputs.thruster_n = allocator.allocate(part, gains.saturation, inputs.thruster_n).force_n;
  return inputs;
}

}  // namespace neritic::rov
