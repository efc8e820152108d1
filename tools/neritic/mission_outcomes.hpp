// How missions and divers' plans went, of vehicles as they believe and in truth, a row a
// participant and seed: what --runs of `dive` and `render` print.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbed/record/file_sinks.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::tools {

// The outcome of one vehicle with a mission or diver with a plan, in one run.
struct MissionOutcome {
  std::string name;
  bool diver = false;
  std::uint64_t seed = 0, arrived = 0, waypoints = 0;
  double time_s = 0.0;  // of the last arrival
  // How far it truly was from each waypoint where it took itself to be there, and at the end from
  // the next one that it did not reach.
  std::vector<double> misses_m;
  std::optional<double> left_m;
  double acceptance_m = 0.0;              // of its waypoints
  std::optional<double> largest_error_m;  // of its navigation
  std::uint64_t touched_steps = 0;
  bool believes_done = false;  // a diver sees where he is

  std::optional<double> worst_miss_m() const;
  // Waypoints where it truly was within acceptance_m + kMissMargin_m of them; of a diver all that
  // were reached or passed.
  std::size_t truly_arrived() const;
  // Done as it believes and in truth.
  bool done() const { return believes_done && truly_arrived() == misses_m.size(); }
};
// A vehicle that flies on what it measures counts as truly at a waypoint if its distance from it is
// at most the waypoint's radius plus this margin: five sigmas of a surveyed launch
// (rov/navigation.hpp).
inline constexpr double kMissMargin_m = 0.5;

// Whether a vehicle has a mission that ends, a diver a plan that ends.
bool has_end(const testbed::PhysicsVehicle& vehicle);
bool has_end(const testbed::PhysicsHuman& human);

// The outcome of each vehicle and each diver that has_end(). log: of all steps up to the state.
std::vector<MissionOutcome> outcomes_of(const testbed::PhysicsWorld& world,
                                        const testbed::PhysicsState& state,
                                        const testbed::DiveLog& log, std::uint64_t seed);

// To standard output; as a table with a last line that sums up, or as JSON.
void print_outcomes(const std::vector<MissionOutcome>& outcomes, bool as_json);

}  // namespace neritic::tools
