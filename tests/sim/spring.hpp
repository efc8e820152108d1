// The smallest system that steps: a mass on a spring under a pushed force, for tests of what drives
// it.
#pragma once

#include <limits>

#include "tests/sim/plain_inbox.hpp"

namespace neritic::sim::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct SpringState {
  double position_m = 1.0, velocity_m_s = 0.0;
  std::uint64_t kicks = 0;
  static void fields(auto&& field, auto& self) {
    field("position_m", self.position_m);
    field("velocity_m_s", self.velocity_m_s);
    field("kicks", self.kicks);
  }
  bool operator==(const SpringState&) const = default;
};

struct SpringInputs {
  double force_n = 0.0;
  Vec3 unused{0.0};
  std::uint32_t kick[2] = {0, 0};
  static void fields(auto&& field, auto& self) {
    field("force_n", self.force_n);
    field("unused", self.unused);
    field("kick", self.kick);
  }
};

inline SpringState spring_step(const SpringState& state, const SpringInputs& inputs, double dt_s) {
  SpringState next = state;
  next.velocity_m_s += (inputs.force_n - 40.0 * state.position_m) * dt_s;
  next.position_m += next.velocity_m_s * dt_s;
  next.kicks += inputs.kick[0];
  return next;
}

using Spring = Simulation<SpringState, SpringInputs, PlainInbox<SpringInputs>>;

template <class Function>
Spring make_spring(SimulationOptions options, Function step) {
  return Spring(options, SpringState{}, SpringInputs{},
                std::make_unique<PlainInbox<SpringInputs>>(), std::move(step),
                apply_whole<SpringInputs>);
}
inline Spring make_spring(SimulationOptions options = {}) {
  return make_spring(options, spring_step);
}

}  // namespace neritic::sim::test
