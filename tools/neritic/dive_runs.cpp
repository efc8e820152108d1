#include "tools/neritic/dive_runs.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/core/json.hpp"
#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "engine/sim/workers.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/record/file_sinks.hpp"
#include "testbed/simulation/mission_outlook.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

// The outcome of one vehicle with a mission, in one run.
struct Outcome {
  std::string vehicle;
  std::uint64_t seed = 0, arrived = 0, waypoints = 0;
  double time_s = 0.0;                    // of the last arrival
  std::optional<double> largest_error_m;  // of its navigation
  std::uint64_t touched_steps = 0;
  bool done = false;
};

struct SeededRun {
  Status status;
  std::vector<Outcome> outcomes;
};

bool has_end(const PhysicsVehicle& vehicle) {
  return vehicle.mission && vehicle.mission->waypoint_count() > 0 && !vehicle.mission->repeats();
}

bool all_done(const PhysicsWorld& world, const PhysicsState& state) {
  for (std::size_t i = 0; i < world.vehicles().size(); ++i)
    if (has_end(world.vehicles()[i]) &&
        !world.vehicles()[i].mission->done(state.vehicles()[i].mission))
      return false;
  return true;
}

SeededRun run_with(scene::Scene scene, std::uint64_t seed, double seconds,
                   const Interrupt& interrupt) {
  scene.seed = seed;
  auto made = PhysicsWorld::create(scene);
  if (!made.ok()) return {Status(made.error()), {}};
  const auto physics = LivePhysics::create(std::move(*made), {.threads = 1});
  const PhysicsWorld& world = physics->world();
  DiveLog log(world, 0.0, {});
  SeededRun run;
  Loop loop(
      {.clock = Clock::simulated(0.0, world.step_s()),
       .physics = physics.get(),
       .step_sinks = {&log},
       .stop = {.frames = static_cast<std::uint64_t>(std::ceil(seconds / world.step_s() - 1e-9)),
                .interrupted = [&] {
                  return interrupt.requested() || all_done(world, physics->newest().state);
                }}});
  run.status = loop.run();
  const PhysicsState& end = physics->newest().state;
  for (std::size_t i = 0; i < world.vehicles().size(); ++i) {
    const PhysicsVehicle& vehicle = world.vehicles()[i];
    if (!has_end(vehicle)) continue;
    const DiveFigures& figures = log.recorder().figures()[i];
    run.outcomes.push_back(
        {vehicle.name, seed, end.vehicles()[i].mission.arrived, vehicle.mission->waypoint_count(),
         figures.arrivals_s.empty() ? 0.0 : figures.arrivals_s.back(),
         figures.largest_navigation_error_m, end.vehicles()[i].contact.touched_steps,
         vehicle.mission->done(end.vehicles()[i].mission)});
  }
  return run;
}

std::string words(const Outcome& o) {
  return o.done ? "done" : "not done";
}

std::string row(const Outcome& o) {
  return fmt::format(
      "{:>10}  {:<12} {:>3} of {:<3} {:>8.1f} s {:>12} {:>14}  {}\n", o.seed, o.vehicle, o.arrived,
      o.waypoints, o.time_s,
      o.largest_error_m ? fmt::format("{:.2f} m", *o.largest_error_m) : std::string("truth"),
      o.touched_steps, words(o));
}

nlohmann::json json_of(const Outcome& o) {
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

void print(const std::vector<Outcome>& outcomes, std::size_t done, bool as_json) {
  if (as_json) {
    nlohmann::json json = nlohmann::json::array();
    for (const Outcome& o : outcomes) json.push_back(json_of(o));
    fmt::print("{}\n", json_text(json));
    return;
  }
  fmt::print("{:>10}  {:<12} {:>10} {:>10} {:>12} {:>14}  status\n", "seed", "vehicle", "waypoints",
             "last after", "nav. error", "touched steps");
  double worst_m = 0.0;
  std::size_t touched = 0;
  for (const Outcome& o : outcomes) {
    fmt::print("{}", row(o));
    worst_m = std::max(worst_m, o.largest_error_m.value_or(0.0));
    touched += o.touched_steps > 0 ? 1 : 0;
  }
  fmt::print("{} of {} missions done, {} touched something, navigation off by up to {:.2f} m\n",
             done, outcomes.size(), touched, worst_m);
}

}  // namespace

Status dive_runs(const DiveFlags& flags, const scene::Scene& scene, double seconds,
                 const Interrupt& interrupt) {
  NERITIC_TRY(const auto world, PhysicsWorld::create(scene));
  if (std::ranges::none_of(world->vehicles(), has_end))
    return refusal("--runs", fmt::format("{}, which has no mission with an end", flags.scene),
                   "waypoints without repeat");
  for (const std::string& line : cannot_hold(*world)) log_warn("{}", line);
  std::vector<SeededRun> runs(*flags.runs);
  Progress progress("run", runs.size());
  std::mutex told;  // guards progress
  sim::Workers workers(std::max(1u, std::thread::hardware_concurrency()));
  workers.run(runs.size(), [&](std::size_t i, unsigned) {
    if (interrupt.requested()) return;
    runs[i] = run_with(scene, scene.seed + i, seconds, interrupt);
    const std::lock_guard lock(told);
    progress.step();
  });
  std::vector<Outcome> outcomes;
  for (const SeededRun& run : runs) {
    NERITIC_TRY_STATUS(run.status);
    outcomes.insert(outcomes.end(), run.outcomes.begin(), run.outcomes.end());
  }
  if (interrupt.requested()) return failure(ErrorCode::kInterrupted, "--runs: interrupted");
  const auto done = static_cast<std::size_t>(std::ranges::count_if(outcomes, &Outcome::done));
  print(outcomes, done, flags.json);
  if (done < outcomes.size())
    return failure(ErrorCode::kUnsupported, "{}: {} of {} missions not done in {:g} s", flags.scene,
                   outcomes.size() - done, outcomes.size(), seconds);
  return {};
}

}  // namespace neritic::tools
