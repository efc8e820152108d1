// `neritic simulate lab`: a scene, its devices and simulators of them in one process, over real
// sockets of this machine, in simulated time: an hour of a lab in minutes.
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "engine/core/log.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/record/source_watch.hpp"
#include "tools/neritic/dive_told.hpp"
#include "tools/neritic/recorded_scene.hpp"
#include "tools/neritic/simulate.hpp"
#include "tools/neritic/step_files.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr double kLabSeconds = 60.0;

void tell_clocks(const std::vector<ClockError>& errors, bool known_well) {
  for (const ClockError& error : errors) {
    if (!error.has_clock) continue;
    fmt::print("{}: its clock is {:+.4f} s off and {:+.1f} ppm; found within {:.3f} ms{}\n",
               error.name, error.true_offset_s, error.true_drift_ppm, std::abs(error.now_ms),
               known_well ? fmt::format(" (at worst {:.3f} ms after the first two minutes)",
                                        error.worst_ms)
                          : "");
  }
}

nlohmann::json clocks_json(const std::vector<ClockError>& errors) {
  nlohmann::json json = nlohmann::json::object();
  for (const ClockError& error : errors)
    if (error.has_clock)
      json[error.name] = {{"true_offset_s", error.true_offset_s},
                          {"true_drift_ppm", error.true_drift_ppm},
                          {"error_ms", error.now_ms},
                          {"worst_ms_after_two_minutes", error.worst_ms}};
  return json;
}

}  // namespace

Status simulate_lab(const SimulateFlags& flags, const scene::Scene& scene,
                    const Interrupt& interrupt) {
  NERITIC_TRY_STATUS(check_step_files(flags.files, {}));
  SimulatedSignals signals;
  NERITIC_TRY_STATUS(read_signals(flags, signals));
  NERITIC_TRY(const LabOptions options, lab_options(flags, signals));
  NERITIC_TRY(auto made, PhysicsWorld::create(scene));
  const auto physics = LivePhysics::create(std::move(made), {.pace = LivePhysics::Pace::kPicture});
  const PhysicsWorld& world = physics->world();
  NERITIC_TRY(const auto devices,
              Devices::open(scene, world, physics->inbox(), DeviceSource::Pace::kPolled));
  const auto seen = [&](std::size_t diver) -> const HumanPhysics& {
    return physics->newest().state.humans()[diver];
  };
  NERITIC_TRY(const auto lab, SimulatedLab::create(scene, world, devices.get(), seen, options));
  SourceWatch watch(world, physics->inbox(), [](const std::string& line) { log_info("{}", line); });
  RecordingOptions recording;
  if (!flags.files.record.empty()) {
    NERITIC_TRY(recording, recording_options(scene.path, false));
    recording.signals = devices->signals();
  }
  const StepFiles files(flags.files, scene.title, recording, *physics);
  std::vector<StepSink*> sinks{&watch};
  for (StepSink* sink : files.sinks()) sinks.push_back(sink);
  const double seconds = flags.seconds.value_or(kLabSeconds), step_s = world.step_s();
  StepProgress progress("second", seconds);
  sinks.push_back(&progress);
  Loop loop({.clock = Clock::simulated(0.0, step_s),
             .physics = physics.get(),
             .sources = {lab.get()},
             .step_sinks = sinks,
             .stop = {.frames = static_cast<std::uint64_t>(std::ceil(seconds / step_s - 1e-9)),
                      .interrupted = [&] { return interrupt.requested(); }}});
  const Status status = loop.run();
  const std::vector<ClockError> errors = lab->clock_errors();
  DiveFlags told;
  told.scene = flags.scene;
  told.quiet = flags.quiet;
  if (flags.json) {
    nlohmann::json json = summary_json(told, world, physics->simulation(), files.recorder(),
                                       {loop.wall_s(), 0, devices->health()});
    json["clocks"] = clocks_json(errors);
    json["packets_sent"] = lab->sent();
    json["packets_lost_on_purpose"] = lab->lost();
    fmt::print("{}\n", json_text(json));
  } else if (!flags.quiet) {
    print_summary(told, world, physics->simulation(), files.recorder(),
                  {loop.wall_s(), 0, devices->health()});
    for (const DeviceHealth& health : devices->health())
      fmt::print("{}\n", health_words(health, health.heard_ns));
    tell_clocks(errors, seconds > SimulatedLab::kKnownAfter_s);
  }
  NERITIC_TRY_STATUS(status);
  if (loop.interrupted())
    return failure(ErrorCode::kInterrupted, "interrupted after {:.4g} s of {:g}",
                   physics->newest().time_s, seconds);
  return {};
}

}  // namespace neritic::tools
