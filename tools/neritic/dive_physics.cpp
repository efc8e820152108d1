#include "tools/neritic/dive_physics.hpp"

#include <cmath>

#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "testbed/devices/devices.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/record/source_watch.hpp"
#include "testbed/samples/recorded_source.hpp"
#include "testbed/simulation/error_outlook.hpp"
#include "testbed/simulation/mission_outlook.hpp"
#include "tools/neritic/device_notes.hpp"
#include "tools/neritic/dive_runs.hpp"
#include "tools/neritic/dive_told.hpp"
#include "tools/neritic/markers.hpp"
#include "tools/neritic/step_files.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr double kPhysicsSeconds = 60.0;  // where --seconds is not given
constexpr double kMostPhysicsSeconds = 1e6;

}  // namespace

Result<std::unique_ptr<LivePhysics>> make_dive_physics(const DiveFlags& flags,
                                                       const scene::Scene& scene,
                                                       const SampleLog* recorded,
                                                       LivePhysics::Pace pace,
                                                       sim::StepClock* clock) {
  NERITIC_TRY(auto world, PhysicsWorld::create(scene));
  LivePhysics::Options options{.pace = pace, .clock = clock};
  if (!flags.restore.empty()) {
    NERITIC_TRY(options.start, read_state(flags.restore, world->state_format()));
  }
  if (recorded) {
    NERITIC_TRY(options.start, start_of(*recorded, flags.replay, *world));
  }
  for (const std::string& line : cannot_hold(*world)) log_warn("{}", line);
  if (const std::string line = not_promised(scene, *world); !line.empty()) log_warn("{}", line);
  return LivePhysics::create(std::move(world), options);
}

Status dive_physics(const DiveFlags& flags, const scene::Scene& scene,
                    std::optional<SampleLog> recorded, const Interrupt& interrupt) {
  double seconds = flags.seconds.value_or(kPhysicsSeconds);
  if (seconds > kMostPhysicsSeconds)
    return refusal("--seconds", fmt::format("{}", seconds),
                   fmt::format("up to {:g}", kMostPhysicsSeconds));
  if (flags.runs) return dive_runs(flags, scene, seconds, interrupt);
  NERITIC_TRY(const auto physics, make_dive_physics(flags, scene, recorded ? &*recorded : nullptr,
                                                    LivePhysics::Pace::kPicture));
  const PhysicsWorld& world = physics->world();
  const double start_s = physics->newest().time_s, step_s = world.step_s();
  SourceWatch watch(world, physics->inbox(), [](const std::string& line) { log_warn("{}", line); });
  RecordingOptions recording;
  if (!flags.files.record.empty()) {
    NERITIC_TRY(recording, recording_options(scene.path, flags.realtime));
  }
  std::unique_ptr<Devices> devices;
  if (!recorded && !scene.sources.empty()) {
    if (!flags.realtime)
      log_warn("{}: its devices send in real time; only --realtime listens to them", flags.scene);
    NERITIC_TRY(devices,
                Devices::open(scene, world, physics->inbox(), DeviceSource::Pace::kThread));
    recording.signals = devices->signals();
  }
  // Recordings: one of a device, one of the whole run.
  std::optional<RecordedSource> played;
  std::unique_ptr<Replay> replay;
  std::vector<SampleSource*> sources;
  if (!flags.play.empty()) {
    NERITIC_TRY(SampleLog log, read_sample_log(flags.play));
    NERITIC_TRY(played, RecordedSource::create(std::move(log), world.streams(), flags.play));
    if (!played->has_samples())
      log_warn("{}: nothing to play: no live sample was recorded", flags.play);
    sources = {&*played};
  }
  if (recorded) {
    NERITIC_TRY(replay, Replay::of(std::move(*recorded), flags.replay, world));
    sources = {&replay->source};
    seconds = replay->seconds();
  }
  if (!flags.markers.empty() && !flags.realtime)
    return refusal("--markers", "a run in simulated time", "--realtime, or a window");
  // After all that may refuse: an older file of their names, maybe the played one, is moved away.
  const StepFiles files(flags.files, scene.title, recording, *physics);
  std::vector<StepSink*> sinks{&watch};
  for (StepSink* sink : files.sinks()) sinks.push_back(sink);
  if (replay) sinks.push_back(&replay->check);
  std::optional<DeviceNotes> device_notes;
  if (devices) {
    for (SampleSource* source : devices->sources()) sources.push_back(source);
    sinks.push_back(&device_notes.emplace(*devices));
  }
  std::unique_ptr<Markers> markers;
  if (!flags.markers.empty()) {
    NERITIC_TRY(markers, Markers::open(flags.markers, files.recording()));
    sinks.push_back(markers.get());
    if (!flags.quiet && !flags.json) fmt::print("{}\n", markers->words());
  }
  StepProgress progress("second", start_s + seconds);
  sinks.push_back(&progress);
  Loop loop(
      {.clock = flags.realtime ? Clock::real(start_s, step_s) : Clock::simulated(start_s, step_s),
       .physics = physics.get(),
       .sources = sources,
       .step_sinks = sinks,
       .stop = {.frames = steps_in(seconds, step_s),
                .interrupted = [&] { return interrupt.requested(); }}});
  const Status status = loop.run();
  // A run that failed prints its summary too, but a replay that did not begin has none.
  if (replay && !status.ok() && replay->check.equal_steps() == 0) return status;
  if (replay && !flags.quiet && !flags.json) replay->tell();
  print_summary(
      flags, world, physics->simulation(), files.recorder(),
      {loop.wall_s(), loop.dropped(), devices ? devices->health() : std::vector<DeviceHealth>()});
  NERITIC_TRY_STATUS(status);
  if (loop.interrupted())
    return failure(ErrorCode::kInterrupted, "interrupted after {:.4g} s of {:g}{}",
                   physics->newest().time_s, seconds,
                   replay ? "" : "; everything up to then is written");
  return replay ? Status() : check_finished(flags, *physics, files.recorder());
}

Status check_finished(const DiveFlags& flags, const LivePhysics& physics,
                      const DiveRecorder& recorder) {
  if (!flags.files.save.empty()) return {};  // it goes on later
  const auto& newest = physics.newest();
  const auto lines = unfinished(physics.world(), newest.state, newest.time_s, &recorder.progress());
  if (lines.empty()) return {};
  return failure(ErrorCode::kUnsupported, "{}: not finished: {}", flags.scene,
                 fmt::join(lines, "; "));
}

}  // namespace neritic::tools
