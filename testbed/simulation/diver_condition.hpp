// The condition and the regulators of a scene's divers, where the scene names them: settings from
// the scene, their part of the step, and what leaves of them. Pure functions; any thread. Each
// diver's step writes its own states and reads those before the step; gas that one diver takes from
// another is settled after all have stepped.
#pragma once

#include <optional>
#include <span>

#include "engine/sim/step_time.hpp"
#include "testbed/simulation/human_world.hpp"

namespace neritic::testbed {

PhysicsCondition physics_condition(const scene::Condition& said, const diver::DiverFile& file);
// An Error for a free flow of a tank that the diver has not got; the donor is found later.
Result<PhysicsRegulator> physics_regulator(const scene::Regulator& said, const diver::Body& body);
// Standard deviations of a person's tolerance of oxygen, normally distributed.
double drawn_tolerance(std::uint64_t seed, std::size_t human);

void start_condition(const PhysicsHuman& human, PhysicsState& state, const HumanPhysics& start);
// All abilities, where the scene names no condition or one that does not act.
Ability ability_of(const PhysicsHuman& human, const PhysicsState& before);
// The donor's gas, if the diver breathes it in this step; then the regulator's state in after says
// so. before: where everybody is.
std::optional<diver::BorrowedTank> borrow(std::span<const PhysicsHuman> humans, std::size_t index,
                                          const Ability& able, const PhysicsInputs& inputs,
                                          const PhysicsState& before, double dt_s,
                                          PhysicsState& after);
// A free flow, out of the diver's own tank.
void blow_off(const PhysicsHuman& human, const PhysicsInputs& inputs, const sim::StepTime& time,
              PhysicsState& after, HumanPhysics& diver);
// borrowed: the gas of another's tank that is breathed; nullptr: its own.
void step_condition(const PhysicsHuman& human, const diver::GasMix* borrowed, double dt_s,
                    PhysicsState& after, const HumanPhysics& diver);
// Takes off the donor's tank what the diver took in this step.
void settle_gas(std::span<const PhysicsHuman> humans, std::size_t index, double taken_moles,
                PhysicsState& after);

ConditionReading condition_reading(const PhysicsHuman& human, const PhysicsState& state,
                                   const HumanPhysics& diver);
SupplyReading supply_reading(std::span<const PhysicsHuman> humans, std::size_t index,
                             const PhysicsState& state);

}  // namespace neritic::testbed
