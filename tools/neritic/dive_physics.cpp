#include "tools/neritic/dive_physics.hpp"

#include <cmath>

#include "engine/core/log.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/record/run_record.hpp"
#include "testbed/record/source_watch.hpp"
#include "testbed/samples/recorded_source.hpp"
#include "tools/neritic/dive_runs.hpp"
#include "tools/neritic/dive_told.hpp"
#include "tools/neritic/step_files.hpp"

namespace neritic::tools {
namespace {

constexpr double kPhysicsSeconds = 60.0;  // where --seconds is not given
constexpr double kMostPhysicsSeconds = 1e6;

bool draws(const DiveFlags& flags) {
  return flags.frames > 0 || flags.fast || flags.panels || flags.validation ||
         !flags.screenshot.empty() || !flags.size.empty() || !flags.sensors.empty() ||
         !flags.device.empty();
}

// The first flag that needs physics; empty: none.
std::string physics_flag(const DiveFlags& flags) {
  if (const std::string flag = first_step_flag(flags.files); !flag.empty()) return flag;
  if (!flags.play.empty()) return "--play";
  if (!flags.replay.empty()) return "--replay";
  if (!flags.restore.empty()) return "--restore";
  if (flags.realtime) return "--realtime";
  if (flags.json) return "--json";
  if (flags.runs) return "--runs";
  return "";
}

Status replay_dive(const DiveFlags& flags, const scene::Scene& scene) {
  NERITIC_TRY(const auto world, PhysicsWorld::create(scene));
  NERITIC_TRY(const SampleLog log, read_sample_log(flags.replay));
  NERITIC_TRY(const sim::ReplayReport report, replay_run(*world, log, flags.replay));
  if (report.first_difference)
    return failure(ErrorCode::kUnsupported, "{}: another state than recorded from step {} of {} on",
                   flags.replay, *report.first_difference, log.steps());
  fmt::print("{}: {} steps, each with the hash that was recorded, the last {:016x}\n", flags.replay,
             report.steps, log.hashes.back());
  return {};
}

}  // namespace

bool asks_for_physics_alone(const DiveFlags& flags, const scene::Scene& scene) {
  return flags.headless && PhysicsWorld::needed(scene) && !draws(flags);
}

Status check_physics_flags(const DiveFlags& flags, const scene::Scene& scene) {
  const std::string flag = physics_flag(flags);
  if (flag.empty()) return {};
  if (!PhysicsWorld::needed(scene))
    return bad_input("{}: accepted where a vehicle has dynamics or a diver swims; in {} none does",
                     flag, flags.scene);
  if ((flags.realtime || flags.runs || !flags.play.empty()) && (!flags.headless || draws(flags)))
    return bad_input("{}: accepted with --headless and without flags of pictures",
                     flags.realtime ? "--realtime"
                     : flags.runs   ? "--runs"
                                    : "--play");
  if (!flags.replay.empty() &&
      (!first_step_flag(flags.files).empty() || flags.realtime || flags.json || flags.seconds ||
       !flags.restore.empty() || !flags.play.empty()))
    return bad_input(
        "--replay: accepted without --seconds, --log, --log-rate, --plot, --record, --save, "
        "--restore, --play, --realtime, --json; it runs as long as the recording");
  if (!flags.restore.empty() && !flags.files.record.empty())
    return bad_input("--record: accepted without --restore: a recording begins at time 0");
  if (flags.runs && (!first_step_flag(flags.files).empty() || flags.realtime ||
                     !flags.replay.empty() || !flags.restore.empty() || !flags.play.empty()))
    return bad_input(
        "--runs: accepted without --log, --log-rate, --plot, --record, --save, --replay, "
        "--restore, --play, --realtime: one run leaves such files (--seed N)");
  return {};
}

Result<std::unique_ptr<LivePhysics>> make_dive_physics(const DiveFlags& flags,
                                                       const scene::Scene& scene,
                                                       LivePhysics::Pace pace) {
  NERITIC_TRY(auto world, PhysicsWorld::create(scene));
  LivePhysics::Options options{
      .pace = pace, .log = !flags.files.record.empty(), .seed = scene.seed};
  if (!flags.restore.empty()) {
    NERITIC_TRY(options.start, read_state(flags.restore, world->state_format()));
  }
  return LivePhysics::create(std::move(world), options);
}

Status dive_physics(const DiveFlags& flags, const scene::Scene& scene, const Interrupt& interrupt) {
  const double seconds = flags.seconds.value_or(kPhysicsSeconds);
  if (seconds > kMostPhysicsSeconds)
    return bad_input("--seconds: {}; up to {:g} is accepted", seconds, kMostPhysicsSeconds);
  if (flags.runs) return dive_runs(flags, scene, interrupt);
  if (!flags.replay.empty()) return replay_dive(flags, scene);
  NERITIC_TRY(const auto physics, make_dive_physics(flags, scene, LivePhysics::Pace::kPicture));
  const double start_s = physics->newest().time_s, step_s = physics->world().step_s();
  std::optional<RecordedSource> recording;
  std::vector<SampleSource*> sources;
  if (!flags.play.empty()) {
    NERITIC_TRY(SampleLog log, read_sample_log(flags.play));
    NERITIC_TRY(recording,
                RecordedSource::create(std::move(log), physics->world().streams(), flags.play));
    sources = {&*recording};
  }
  const StepFiles files(flags.files, scene.title, *physics);
  StepProgress progress("second", start_s + seconds);
  SourceWatch watch(physics->world(), physics->inbox(),
                    [](const std::string& line) { log_warn("{}", line); });
  std::vector<StepSink*> sinks{&progress, &watch};
  for (StepSink* sink : files.sinks()) sinks.push_back(sink);
  Loop loop(
      {.clock = flags.realtime ? Clock::real(start_s, step_s) : Clock::simulated(start_s, step_s),
       .physics = physics.get(),
       .sources = sources,
       .step_sinks = sinks,
       .stop = {.frames = static_cast<std::uint64_t>(std::ceil(seconds / step_s - 1e-9)),
                .interrupted = [&] { return interrupt.requested(); }}});
  const Status written = loop.run();
  print_summary(flags, physics->world(), physics->simulation(), files.recorder(),
                {loop.wall_s(), loop.dropped()});
  NERITIC_TRY_STATUS(written);
  if (loop.interrupted())
    return failure(ErrorCode::kInterrupted,
                   "interrupted after {:.4g} s of {:g}; all until then is written",
                   physics->newest().time_s, seconds);
  return {};
}

}  // namespace neritic::tools
