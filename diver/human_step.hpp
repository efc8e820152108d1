// One step of a diver: limbs, water, breath, gas. `step(body, state, inputs, dt)` is a pure
// function without clock, file, thread or allocation: the same bits for the same arguments. World
// north, east, down; body axes forward (to the head), starboard, down (out of the belly). Any
// thread.
#pragma once

#include "diver/human_state.hpp"

namespace neritic::diver {

// Longer steps are cut into equal ones no longer than this; `neritic tradeoff swim`.
inline constexpr double kLongestSubstep_s = 1.0 / 60.0;

// No water speeds up by more, in any axis.
inline constexpr double kMostWaterAcceleration_m_s2 = 100.0;

// Inputs that are not finite or beyond any diver's are refused: the last good value is held, and
// state.refused_inputs counts it (each joint for itself). So is a dt_s outside (0, 10] s: then
// nothing moves. The result is finite if the state was. borrowed: breathed from in place of the
// diver's own tanks.
HumanState step(const Body& body, const HumanState& state, const HumanInputs& inputs, double dt_s,
                double longest_substep_s = kLongestSubstep_s, BorrowedTank* borrowed = nullptr);

// At rest at a pose, tanks full, joints as given, the jacket filled so far that the diver floats
// there in the middle of a quiet breath (or empty, where the diver floats without).
HumanState start_at(const Body& body, const Vec3& position_ned_m, const Quat& ned_from_body,
                    const JointRotations& joints = straight_joints());

// To rest at another pose, limbs, breath and gas as they are. False, and no change, where that is
// not finite.
bool teleport(HumanState& state, const Vec3& position_ned_m, const Quat& ned_from_body);

// Gas in lungs, jacket and tanks, as loads.
GasLoad gas_load(const Body& body, const HumanState& state);
ThoraxPlace thorax_place(const Body& body, const HumanState& state);
// Newtons down at rest: weight less buoyancy.
double net_weight_n(const Body& body, const HumanState& state);

// For displays and logs.
struct GasReading {
  double ambient_pa = 0.0, tank_pa = 0.0, ventilation_l_min = 0.0, breaths_min = 0.0;
  double remaining_s = 0.0;  // to 50 bar at this rate
  double jacket_m3 = 0.0;
};
GasReading read_gas(const Body& body, const HumanState& state);

}  // namespace neritic::diver
