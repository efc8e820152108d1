// How missions went, a row a vehicle and seed: what --runs of `dive` and `render` print.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbed/record/file_sinks.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::tools {

// The outcome of one vehicle with a mission, in one run.
struct MissionOutcome {
  std::string vehicle;
  std::uint64_t seed = 0, arrived = 0, waypoints = 0;
  double time_s = 0.0;                    // of the last arrival
  std::optional<double> largest_error_m;  // of its navigation
  std::uint64_t touched_steps = 0;
  bool done = false;
};

// Whether a vehicle has a mission that ends.
bool has_end(const testbed::PhysicsVehicle& vehicle);

// The outcome of each vehicle that has a mission. log: of all steps up to the state.
std::vector<MissionOutcome> outcomes_of(const testbed::PhysicsWorld& world,
                                        const testbed::PhysicsState& state,
                                        const testbed::DiveLog& log, std::uint64_t seed);

// To standard output; as a table with a last line that sums up, or as JSON.
void print_outcomes(const std::vector<MissionOutcome>& outcomes, bool as_json);

}  // namespace neritic::tools
