#include "tools/neritic/mission_outcomes.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

std::string words(const MissionOutcome& o) {
  return o.done ? "done" : "not done";
}

std::string row(const MissionOutcome& o) {
  return fmt::format(
      "{:>10}  {:<12} {:>3} of {:<3} {:>8.1f} s {:>12} {:>14}  {}\n", o.seed, o.vehicle, o.arrived,
      o.waypoints, o.time_s,
      o.largest_error_m ? fmt::format("{:.2f} m", *o.largest_error_m) : std::string("truth"),
      o.touched_steps, words(o));
}

nlohmann::json json_of(const MissionOutcome& o) {
  return {{"seed", o.seed},
          {"vehicle", o.vehicle},
          {"waypoints", o.waypoints},
          {"arrived", o.arrived},
          {"last_arrival_s", o.time_s},
          {"largest_navigation_error_m",
           o.largest_error_m ? nlohmann::json(*o.largest_error_m) : nlohmann::json()},
          {"touched_steps", o.touched_steps},
          {"status", words(o)}};
}

}  // namespace

bool has_end(const PhysicsVehicle& vehicle) {
  return vehicle.mission && vehicle.mission->waypoint_count() > 0 && !vehicle.mission->repeats();
}

std::vector<MissionOutcome> outcomes_of(const PhysicsWorld& world, const PhysicsState& state,
                                        const DiveLog& log, std::uint64_t seed) {
  std::vector<MissionOutcome> outcomes;
  for (std::size_t i = 0; i < world.vehicles().size(); ++i) {
    const PhysicsVehicle& vehicle = world.vehicles()[i];
    if (!has_end(vehicle)) continue;
    const DiveFigures& figures = log.recorder().figures()[i];
    const auto& own = state.vehicles()[i];
    outcomes.push_back({vehicle.name, seed, own.mission.arrived, vehicle.mission->waypoint_count(),
                        figures.arrivals_s.empty() ? 0.0 : figures.arrivals_s.back(),
                        figures.largest_navigation_error_m, own.contact.touched_steps,
                        vehicle.mission->done(own.mission)});
  }
  return outcomes;
}

void print_outcomes(const std::vector<MissionOutcome>& outcomes, bool as_json) {
  const auto done = std::ranges::count_if(outcomes, &MissionOutcome::done);
  if (as_json) {
    nlohmann::json json = nlohmann::json::array();
    for (const MissionOutcome& o : outcomes) json.push_back(json_of(o));
    fmt::print("{}\n", json_text(json));
    return;
  }
  fmt::print("{:>10}  {:<12} {:>10} {:>10} {:>12} {:>14}  status\n", "seed", "vehicle", "waypoints",
             "last after", "nav. error", "touched steps");
  double worst_m = 0.0;
  std::size_t touched = 0;
  for (const MissionOutcome& o : outcomes) {
    fmt::print("{}", row(o));
    worst_m = std::max(worst_m, o.largest_error_m.value_or(0.0));
    touched += o.touched_steps > 0 ? 1 : 0;
  }
  fmt::print("{} of {} missions done, {} touched something, navigation off by up to {:.2f} m\n",
             done, outcomes.size(), touched, worst_m);
}

}  // namespace neritic::tools
