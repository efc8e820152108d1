// What a dive without pictures says at its end on standard output: a line for each vehicle and
// diver, what endangered the divers, or all of it as JSON.
#pragma once

#include <cstdint>

#include "testbed/record/dive_record.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {
using namespace testbed;

// How the steps went.
struct Pace {
  double wall_s = 0.0;
  std::uint64_t dropped = 0;
  bool interrupted = false;
};

// By --json as JSON.
void print_summary(const DiveFlags& flags, const PhysicsWorld& world,
                   const PhysicsSimulation& simulation, const DiveRecorder& recorder,
                   const Pace& pace);

}  // namespace neritic::tools
