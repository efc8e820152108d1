// One step of a vehicle, `step(vehicle, state, inputs, dt)`: a pure function without clock, file,
// thread or allocation, the same bits for the same arguments. World axes north, east, down; body
// axes forward, starboard, down. Any thread.
#pragma once

#include <span>
#include <string_view>

#include "rov/dynamics.hpp"

namespace neritic::rov {

enum class Integrator {
  // Order 1. Velocity with implicit drag, solved by Newton's method; then the pose with the new
  // velocity. Thruster lag exactly.
  kSemiImplicit,
  // Order 4. The classical method over all of the state, thruster lag included; diverges where the
  // step is too long for the lag or the drag.
  kRk4,
  // Order 4, the default. Thrust acts as its lag's exact impulses, the rest is RK4 in as many
  // substeps as keep the fastest rate times the substep below a bound.
  // If that takes too many substeps, the step is backward Euler with implicit Coriolis terms,
  // which cannot add more energy than the forces gave.
  // No step of it diverges, whatever its length.
  kGuarded,
};
std::string_view name_of(Integrator integrator);
// "semi_euler", "rk4", "guarded".
Result<Integrator> integrator_of(std::string_view name);

// A wrench beside the inputs' that changes during the step: at(context, t) at t seconds after its
// start. For tests and checks against closed forms.
struct VaryingWrench {
  Vec6 (*at)(const void* context, double t_s) = nullptr;
  const void* context = nullptr;
};

// No vehicle's inputs are larger.
inline constexpr double kMostForce = 1e9;  // N, N m
inline constexpr double kMostCurrent_m_s = 100.0;
inline constexpr double kMostWaterAcceleration_m_s2 = 100.0;  // in each axis

// Inputs that are not finite, or larger than these, are refused: the last good value is held (at
// first zero) and state.refused_inputs counts it. So is a dt outside (0, 10] s: then nothing moves.
// The result is finite if the state was.
State step(const Vehicle& vehicle, const State& state, const Inputs& inputs, double dt_s,
           Integrator integrator = Integrator::kGuarded, const VaryingWrench& varying = {});

// Substeps that kGuarded takes for this step; 0: semi-implicit ones instead.
int guarded_substeps(const Vehicle& vehicle, const State& state, const Inputs& inputs, double dt_s);

// Sets the state to rest at a pose. False, and no change, where that is not finite.
bool teleport(State& state, const Vec3& position_ned_m, const Quat& attitude);

}  // namespace neritic::rov
