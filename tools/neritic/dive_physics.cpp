#include "tools/neritic/dive_physics.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "testbed/record/dive_record.hpp"
#include "testbed/record/run_record.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/dive_picture.hpp"
#include "tools/neritic/dive_told.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/interrupt.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr double kPhysicsSeconds = 60.0;  // where --seconds is not given
constexpr double kMostPhysicsSeconds = 1e6;

bool draws(const DiveFlags& flags) {
  return flags.frames > 0 || flags.fast || flags.panels || flags.validation ||
         !flags.screenshot.empty() || !flags.size.empty() || !flags.sensors.empty() ||
         !flags.device.empty();
}

// The first flag that only a dive of physics alone takes; empty: none.
std::string physics_flag(const DiveFlags& flags) {
  if (!flags.log.empty()) return "--log";
  if (flags.log_rate_hz) return "--log-rate";
  if (!flags.plot.empty()) return "--plot";
  if (!flags.record.empty()) return "--record";
  if (!flags.replay.empty()) return "--replay";
  if (!flags.save.empty()) return "--save";
  if (!flags.restore.empty()) return "--restore";
  if (flags.realtime) return "--realtime";
  if (flags.json) return "--json";
  return "";
}

// As fast as it can, or each step when it is due.
Pace run_steps(PhysicsSimulation& simulation, DiveRecorder& recorder, const DiveFlags& flags,
               double seconds, double step_s, const Interrupt& interrupt) {
  constexpr int kCatchUp = 4;  // as the live program's
  const auto steps = static_cast<std::uint64_t>(std::ceil(seconds / step_s - 1e-9));
  sim::HostClock clock;
  const TimeNs begun_ns = clock.now();
  sim::StepPacer pacer(1.0 / step_s, kCatchUp, begun_ns);
  Progress progress("second", static_cast<std::uint64_t>(std::ceil(seconds)));
  double told_s = simulation.newest().time_s;
  recorder.add(simulation.newest());
  Pace pace;
  for (std::uint64_t done = 0; done < steps;) {
    pace.interrupted = interrupt.requested();
    if (pace.interrupted) break;
    std::uint64_t now = 1;
    if (flags.realtime) {
      clock.wait_until(pacer.next_ns());
      now = std::min<std::uint64_t>(static_cast<std::uint64_t>(pacer.take(clock.now())),
                                    steps - done);
    }
    for (std::uint64_t i = 0; i < now; ++i, ++done) {
      simulation.advance(1);
      recorder.add(simulation.newest());
    }
    for (; told_s + 1.0 <= simulation.newest().time_s; told_s += 1.0) progress.step();
  }
  pace.wall_s = static_cast<double>(clock.now() - begun_ns) * 1e-9;
  pace.dropped = pacer.counts().dropped;
  return pace;
}

// Where a result of hours could not be written is better known before them.
Status check_writable(const std::filesystem::path& path) {
  if (path.empty()) return {};
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && std::filesystem::is_other(status)) return {};
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(status) && ::access(folder.c_str(), W_OK | X_OK) == 0)
    return {};
  return failure(ErrorCode::kIo, "{}: cannot be written", path.string());
}

// All that was asked for, also where one of them fails; the first failure.
Status write_results(const DiveFlags& flags, const std::string& title, const PhysicsWorld& world,
                     const PhysicsSimulation& simulation, const DiveRecorder& recorder) {
  std::vector<Status> written;
  if (!flags.save.empty())
    written.push_back(
        write_state(flags.save, world.state_format(),
                    {simulation.newest().step, simulation.newest().state, simulation.inputs()}));
  if (!flags.record.empty())
    written.push_back(write_sample_log(flags.record, recorded_run(world, simulation)));
  if (!flags.log.empty())
    written.push_back(
        write_text(flags.log, csv_of(world, recorder.rows(), recorder.humans().rows())));
  if (!flags.plot.empty()) {
    const auto drawn = write_picture(flags.plot, dive_picture_data(title, world, recorder));
    written.push_back(drawn.ok() ? Status() : Status(drawn.error()));
  }
  for (const Status& status : written) NERITIC_TRY_STATUS(status);
  return {};
}

Status replay_dive(const DiveFlags& flags, const PhysicsWorld& world) {
  NERITIC_TRY(const SampleLog log, read_sample_log(flags.replay));
  NERITIC_TRY(const sim::ReplayReport report, replay_run(world, log, flags.replay));
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
  const double log_rate_hz = flags.log_rate_hz.value_or(0.0);
  if (!(log_rate_hz >= 0.0 && log_rate_hz <= 1e4))
    return bad_input("--log-rate: {}; a number from 0 to 10000 is accepted", log_rate_hz);
  if (flag.empty()) return {};
  if (!PhysicsWorld::needed(scene))
    return bad_input("{}: accepted where a vehicle has dynamics or a diver swims; in {} none does",
                     flag, flags.scene);
  if (!flags.headless || draws(flags))
    return bad_input("{}: accepted with --headless and without flags of pictures", flag);
  if (!flags.replay.empty() && (!flags.log.empty() || !flags.record.empty() || flags.realtime ||
                                !flags.plot.empty() || flags.json || flags.seconds ||
                                flags.log_rate_hz || !flags.save.empty() || !flags.restore.empty()))
    return bad_input(
        "--replay: accepted without --seconds, --log, --log-rate, --plot, --record, --save, "
        "--restore, --realtime, --json; it runs as long as the recording");
  if (!flags.restore.empty() && !flags.record.empty())
    return bad_input("--record: accepted without --restore: a recording begins at time 0");
  return {};
}

Status dive_physics(const DiveFlags& flags, const scene::Scene& scene) {
  const double seconds = flags.seconds.value_or(kPhysicsSeconds);
  if (seconds > kMostPhysicsSeconds)
    return bad_input("--seconds: {}; up to {:g} is accepted", seconds, kMostPhysicsSeconds);
  NERITIC_TRY(const auto world, PhysicsWorld::create(scene));
  if (!flags.replay.empty()) return replay_dive(flags, *world);
  for (const std::string& file : {flags.log, flags.plot, flags.record, flags.save})
    NERITIC_TRY_STATUS(check_writable(file));
  const auto simulation = world->simulation({.seed = scene.seed});
  if (!flags.restore.empty()) {
    NERITIC_TRY(const SavedState saved, read_state(flags.restore, world->state_format()));
    simulation->restore(saved.step, saved.state, saved.inputs);
  }
  DiveRecorder recorder(*world, {.rows = !flags.log.empty() || !flags.plot.empty(),
                                 .row_rate_hz = flags.log_rate_hz.value_or(0.0)});
  const Interrupt interrupt;
  const Pace pace = run_steps(*simulation, recorder, flags, seconds, world->step_s(), interrupt);
  const Status written = write_results(flags, scene.title, *world, *simulation, recorder);
  print_summary(flags, *world, *simulation, recorder, pace);
  NERITIC_TRY_STATUS(written);
  if (pace.interrupted)
    return failure(ErrorCode::kInterrupted,
                   "interrupted after {:.4g} s of {:g}; all until then is written",
                   simulation->newest().time_s, seconds);
  return {};
}

}  // namespace neritic::tools
