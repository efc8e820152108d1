// A diver on its own who swims to goals, step by step.
#pragma once

#include "diver/swimmer.hpp"
#include "tests/diver/bodies.hpp"

namespace neritic::diver {

struct Swim {
  HumanState state;
  HumanInputs inputs;
  SwimmerState swimmer;
};
inline Swim begin(const Body& body, const Vec3& at, double heading_deg) {
  return {start_at(body, at, glm::angleAxis(radians(heading_deg), Vec3(0, 0, 1)),
                   rotations_of(streamlined(body))),
          {},
          {}};
}
template <class Seen>
void swim_for(const Body& body, Swim& s, const SwimGoal& goal, double seconds, const Seen& seen) {
  for (int i = 0; i < static_cast<int>(seconds * 240); ++i) {
    if (i % 4 == 0) swim(body, SwimmerSettings{}, goal, s.state, s.swimmer, 1.0 / 60.0, s.inputs);
    s.state = step(body, s.state, s.inputs, 1.0 / 240.0);
    seen(s.state);
  }
}

}  // namespace neritic::diver
