#include "rov/thrust_priority.hpp"

#include <algorithm>

namespace neritic::rov {
namespace {

Inputs allocated(const Allocator& allocator, const ControlGains& gains, const Vec6& wrench,
                 const State& state) {
  Inputs inputs = state.held;
  inputs.wrench = {};
  inputs.thruster_n = allocator.allocate(wrench, gains.saturation).force_n;
  return inputs;
}

}  // namespace

Vec6 with_room(const Vehicle& vehicle, const Allocator& allocator, const Vec6& holding,
               const Vec6& push) {
  const auto held_n = allocator.allocate(holding).wanted_n;
  const auto push_n = allocator.allocate(push).wanted_n;
  double share = 1.0;
  for (std::size_t i = 0; i < vehicle.thruster_count; ++i) {
    if (push_n[i] == 0.0) continue;
    const double limit_n =
        push_n[i] > 0.0 ? vehicle.thrusters[i].max_n : vehicle.thrusters[i].min_n;
    share = std::min(share, (limit_n - held_n[i]) / push_n[i]);
  }
  return std::max(0.0, share) * push;
}

Vec6 level_first(const Vehicle& vehicle, const Allocator& allocator, const Vec6& wrench,
                 const State& state) {
  const Vec3 munk = glm::cross(state.velocity.linear(), (vehicle.mass * state.velocity).linear());
  const Vec6 moments = vec6(Vec3(0.0), wrench.angular() + munk);
  return moments + with_room(vehicle, allocator, moments, vec6(wrench.linear(), Vec3(0.0)));
}

Inputs level_inputs(const Vehicle& vehicle, const Allocator& allocator, const ControlGains& gains,
                    const Setpoint& setpoint, const State& state, ControlState& control) {
  const Vec6 wrench = control_wrench(vehicle, gains, setpoint, state, control);
  return allocated(allocator, gains, level_first(vehicle, allocator, wrench, state), state);
}

Inputs piloted_inputs(const Vehicle& vehicle, const Allocator& allocator, const ControlGains& gains,
                      const Setpoint& setpoint, const State& state, ControlState& control) {
  Setpoint held = setpoint;
  held.pilot = {};
  const Vec6 holding = control_wrench(vehicle, gains, held, state, control);
  return allocated(allocator, gains,
                   holding + with_room(vehicle, allocator, holding, setpoint.pilot), state);
}

}  // namespace neritic::rov
