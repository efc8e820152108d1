#include "tools/neritic/dive_runs.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <thread>

#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "engine/sim/workers.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/record/file_sinks.hpp"
#include "testbed/simulation/error_outlook.hpp"
#include "testbed/simulation/mission_outlook.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/mission_outcomes.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

struct SeededRun {
  Status status;
  std::vector<MissionOutcome> outcomes;
};

bool all_done(const PhysicsWorld& world, const PhysicsState& state) {
  for (std::size_t i = 0; i < world.vehicles().size(); ++i)
    if (has_end(world.vehicles()[i]) &&
        !world.vehicles()[i].mission->done(state.vehicles()[i].mission))
      return false;
  for (std::size_t i = 0; i < world.humans().size(); ++i)
    if (has_end(world.humans()[i]) &&
        state.humans()[i].arrived < world.humans()[i].waypoints_ned_m.size())
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
  Loop loop({.clock = Clock::simulated(0.0, world.step_s()),
             .physics = physics.get(),
             .step_sinks = {&log},
             .stop = {.frames = steps_in(seconds, world.step_s()), .interrupted = [&] {
                        return interrupt.requested() || all_done(world, physics->newest().state);
                      }}});
  run.status = loop.run();
  const PhysicsState& end = physics->newest().state;
  run.outcomes = outcomes_of(world, end, log, seed);
  return run;
}

}  // namespace

Status dive_runs(const DiveFlags& flags, const scene::Scene& scene, double seconds,
                 const Interrupt& interrupt) {
  NERITIC_TRY(const auto world, PhysicsWorld::create(scene));
  const auto ends = [](const auto& participant) { return has_end(participant); };
  if (std::ranges::none_of(world->vehicles(), ends) && std::ranges::none_of(world->humans(), ends))
    return refusal("--runs", fmt::format("{}, which has no mission with an end", flags.scene),
                   "waypoints without repeat, of a vehicle or of a diver's swim");
  for (const std::string& line : cannot_hold(*world)) log_warn("{}", line);
  if (const std::string line = not_promised(scene, *world); !line.empty()) log_warn("{}", line);
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
  std::vector<MissionOutcome> outcomes;
  for (const SeededRun& run : runs) {
    NERITIC_TRY_STATUS(run.status);
    outcomes.insert(outcomes.end(), run.outcomes.begin(), run.outcomes.end());
  }
  if (interrupt.requested()) return failure(ErrorCode::kInterrupted, "--runs: interrupted");
  const auto done =
      static_cast<std::size_t>(std::ranges::count_if(outcomes, &MissionOutcome::done));
  const auto believed =
      static_cast<std::size_t>(std::ranges::count_if(outcomes, &MissionOutcome::believes_done));
  print_outcomes(outcomes, flags.json);
  if (done < outcomes.size())
    return failure(ErrorCode::kUnsupported, "{}: {} of {} missions not done in {:g} s{}",
                   flags.scene, outcomes.size() - done, outcomes.size(), seconds,
                   believed > done
                       ? fmt::format(", {} of them missed though the vehicle believes it arrived",
                                     believed - done)
                       : "");
  return {};
}

}  // namespace neritic::tools
