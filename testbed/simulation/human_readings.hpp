// The numbers that a diver's state gives to logs, to samples and to a dive computer's display. Pure
// functions without allocation; any thread.
#pragma once

#include "diver/ascent_gas.hpp"
#include "testbed/simulation/gaze_targets.hpp"
#include "testbed/simulation/human_world.hpp"

namespace neritic::testbed {

// The gas that the way up takes as the diver breathes now, but at least at the rate that plans use.
diver::AscentGas gas_for_ascent(const PhysicsHuman& human, const HumanPhysics& state);

DiverMotion motion_reading(const PhysicsHuman& human, const HumanPhysics& state);
HumanReading human_reading(const PhysicsHuman& human, const HumanPhysics& state,
                           const GazeTargets::Seen& seen);
ComputerReading computer_reading(const PhysicsHuman& human, const HumanPhysics& state);

}  // namespace neritic::testbed
