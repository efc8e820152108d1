#include "tools/neritic/mission_outcomes.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

std::string words(const MissionOutcome& o) {
  if (!o.believes_done) return "not done";
  return o.done() ? "done" : "missed";
}

std::string metres_or(const std::optional<double>& metres, const char* other) {
  return metres ? fmt::format("{:.2f} m", *metres) : std::string(other);
}

std::string row(const MissionOutcome& o) {
  return fmt::format(
      "{:>10}  {:<12} {:>3} of {:<3} {:>5} {:>10} {:>8.1f} s {:>12} {:>14}  {}\n", o.seed, o.name,
      o.arrived, o.waypoints, o.truly_arrived(), metres_or(o.worst_miss_m(), "-"), o.time_s,
      metres_or(o.largest_error_m, o.diver ? "-" : "truth"), o.touched_steps, words(o));
}

nlohmann::json metres_or_null(const std::optional<double>& number) {
  return number ? nlohmann::json(*number) : nlohmann::json();
}

nlohmann::json json_of(const MissionOutcome& o) {
  return {{"seed", o.seed},
          {o.diver ? "diver" : "vehicle", o.name},
          {"waypoints", o.waypoints},
          {"arrived", o.arrived},
          {"truly_arrived", o.truly_arrived()},
          {"true_misses_m", o.misses_m},
          {"to_next_m", metres_or_null(o.left_m)},
          {"last_arrival_s", o.time_s},
          {"largest_navigation_error_m", metres_or_null(o.largest_error_m)},
          {"touched_steps", o.touched_steps},
          {"status", words(o)}};
}

}  // namespace

std::optional<double> MissionOutcome::worst_miss_m() const {
  if (misses_m.empty()) return std::nullopt;
  return *std::ranges::max_element(misses_m);
}

std::size_t MissionOutcome::truly_arrived() const {
  if (diver) return misses_m.size();
  return static_cast<std::size_t>(std::ranges::count_if(
      misses_m, [&](double miss_m) { return miss_m <= acceptance_m + kMissMargin_m; }));
}

bool has_end(const PhysicsVehicle& vehicle) {
  return vehicle.mission && vehicle.mission->waypoint_count() > 0 && !vehicle.mission->repeats();
}

bool has_end(const PhysicsHuman& human) {
  return !human.waypoints_ned_m.empty() && !human.repeat;
}

namespace {

// Of a diver who swims by plan.
MissionOutcome outcome_of(const PhysicsHuman& human, const HumanPhysics& state,
                          const HumanFigures& figures, std::uint64_t seed) {
  MissionOutcome out;
  out.name = human.name;
  out.diver = true;
  out.seed = seed;
  out.arrived = state.arrived;
  out.waypoints = human.waypoints_ned_m.size();
  out.time_s = figures.arrivals_s.empty() ? 0.0 : figures.arrivals_s.back();
  out.misses_m = figures.misses_m;
  out.acceptance_m = human.acceptance_m;
  out.touched_steps = state.contact.touched_steps;
  out.believes_done = state.arrived >= out.waypoints;
  if (!out.believes_done)
    out.left_m =
        glm::distance(state.human.root.position_ned_m, human.waypoints_ned_m[state.arrived]);
  return out;
}

}  // namespace

std::vector<MissionOutcome> outcomes_of(const PhysicsWorld& world, const PhysicsState& state,
                                        const DiveLog& log, std::uint64_t seed) {
  std::vector<MissionOutcome> outcomes;
  for (std::size_t i = 0; i < world.vehicles().size(); ++i) {
    const PhysicsVehicle& vehicle = world.vehicles()[i];
    if (!has_end(vehicle)) continue;
    const DiveFigures& figures = log.recorder().figures()[i];
    const auto& own = state.vehicles()[i];
    MissionOutcome& out = outcomes.emplace_back();
    out.name = vehicle.name;
    out.seed = seed;
    out.arrived = own.mission.arrived;
    out.waypoints = vehicle.mission->waypoint_count();
    out.time_s = figures.arrivals_s.empty() ? 0.0 : figures.arrivals_s.back();
    out.misses_m = figures.misses_m;
    out.acceptance_m = vehicle.mission->acceptance_m();
    out.largest_error_m = figures.largest_navigation_error_m;
    out.touched_steps = own.contact.touched_steps;
    out.believes_done = vehicle.mission->done(own.mission);
    if (!out.believes_done)
      out.left_m =
          glm::distance(own.body.position_ned_m, vehicle.mission->waypoints_ned_m()[out.arrived]);
  }
  for (std::size_t i = 0; i < world.humans().size(); ++i)
    if (has_end(world.humans()[i]))
      outcomes.push_back(outcome_of(world.humans()[i], state.humans()[i],
                                    log.recorder().humans().figures()[i], seed));
  return outcomes;
}

void print_outcomes(const std::vector<MissionOutcome>& outcomes, bool as_json) {
  const auto done = std::ranges::count_if(outcomes, &MissionOutcome::done);
  const auto believed = std::ranges::count_if(outcomes, &MissionOutcome::believes_done);
  if (as_json) {
    nlohmann::json json = nlohmann::json::array();
    for (const MissionOutcome& o : outcomes) json.push_back(json_of(o));
    fmt::print("{}\n", json_text(json));
    return;
  }
  fmt::print("{:>10}  {:<12} {:>10} {:>5} {:>10} {:>10} {:>12} {:>14}  status\n", "seed", "name",
             "waypoints", "truly", "true miss", "last after", "nav. error", "touched steps");
  double worst_m = 0.0;
  std::size_t touched = 0;
  for (const MissionOutcome& o : outcomes) {
    fmt::print("{}", row(o));
    worst_m = std::max(worst_m, o.largest_error_m.value_or(0.0));
    touched += o.touched_steps > 0 ? 1 : 0;
  }
  const bool navigated = std::ranges::any_of(
      outcomes, [](const MissionOutcome& o) { return o.largest_error_m.has_value(); });
  fmt::print(
      "{} of {} missions done, {} touched something{}\n", done, outcomes.size(), touched,
      navigated ? fmt::format(", navigation off by up to {:.2f} m", worst_m) : std::string());
  if (believed > done)
    fmt::print(
        "{} missed: done as the vehicle believes, but truly off a waypoint by more than its radius "
        "and {:g} m\n",
        believed - done, kMissMargin_m);
}

}  // namespace neritic::tools
