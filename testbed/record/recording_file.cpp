#include "testbed/record/recording_file.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/files.hpp"
#include "engine/recording/cdr.hpp"
#include "engine/recording/ros_types.hpp"

namespace neritic::testbed {
namespace {

SampleLog run_of(const PhysicsWorld& world, const PhysicsSimulation& simulation,
                 const RecordingOptions& options) {
  SampleLog run;
  const StateFormat format = world.state_format();
  run.step_s = world.step_s();
  run.seed = world.seed();
  run.streams = logged_streams(world.streams());
  run.first_step = simulation.newest().step;
  run.scene_path = options.scene_path;
  run.scene_text = options.scene_text;
  run.scene_hash = format.scene_hash;
  if (run.first_step > 0) run.start_state = encode_state(format, saved_state(simulation, format));
  return run;
}

}  // namespace

Result<RecordingOptions> recording_of_scene(const std::filesystem::path& scene) {
  NERITIC_TRY(std::string text, read_text(scene));
  std::error_code error;
  const auto path = std::filesystem::absolute(scene, error);
  return RecordingOptions{.scene_path = error ? scene.string() : path.lexically_normal().string(),
                          .scene_text = std::move(text)};
}

RecordingFile::RecordingFile(const PhysicsWorld& world, const PhysicsSimulation& simulation,
                             std::filesystem::path path, RecordingOptions options)
    : world_(world),
      inbox_(simulation.inbox()),
      options_(std::move(options)),
      file_(std::move(path)),
      log_(file_, run_of(world, simulation, options_), options_.recorded_at_ns),
      ros_(file_, world),
      signal_channels_(options_.signals.size()) {
  name_sources();
  for (const SignalSource& source : options_.signals) source.queue->want(true);
}

void RecordingFile::name_sources() {
  const auto names = inbox_.source_names();
  while (log_.sources() < names.size()) log_.source(names[log_.sources()]);
}

void RecordingFile::tell_failure() {
  if (!file_.failed() || told_) return;
  told_ = true;
  if (options_.on_failure) options_.on_failure(file_.status().error().message);
}

Status RecordingFile::use(const Sample& sample) {
  if (file_.failed()) return {};
  if (sample.header.source >= log_.sources()) name_sources();
  log_.sample(sample);
  return {};
}

Status RecordingFile::accept(const sim::Snapshot<PhysicsState>& step,
                             std::span<const Sample> outputs) {
  if (file_.failed()) {
    tell_failure();
    return {};
  }
  log_.step(step.step, step.time_s, step.host_ns, step.hash);
  ros_.step(step);
  for (const Sample& sample : outputs)
    if (!ros_.output(sample, log_.now_ns(), log_.scene_ns(sample.header.captured_ns)))
      log_.sample(sample);
  write_signals(step);
  return {};
}

void RecordingFile::write_signals(const sim::Snapshot<PhysicsState>& step) {
  const auto log_ns = static_cast<std::uint64_t>(std::llround(1e9 * step.time_s));
  for (std::size_t i = 0; i < options_.signals.size(); ++i) {
    const SignalSource& source = options_.signals[i];
    SignalChannel& channel = signal_channels_[i];
    for (const SignalPacket& packet : source.queue->take()) {
      if (!channel.id)
        channel.id = file_.add_channel(
            {file_.add_schema(recording::ros_schema(
                 source.kind == "ecg" ? "neritic_msgs/msg/Ecg" : "neritic_msgs/msg/Audio")),
             "/" + source.name + "/" + source.kind,
             "cdr",
             {}});
      const TimeNs stamp_ns = std::max<TimeNs>(packet.captured_ns + step.scene_from_host_ns(), 0);
      std::string message;
      recording::CdrWriter cdr(message);
      cdr.header(stamp_ns, source.name);
      cdr.number(packet.rate_hz);
      cdr.count(packet.samples.size());
      for (const float sample : packet.samples) cdr.number(sample);
      file_.message({*channel.id, channel.sequence++, log_ns, static_cast<std::uint64_t>(stamp_ns),
                     std::as_bytes(std::span(message))});
    }
  }
}

Status RecordingFile::finish() {
  for (const SignalSource& source : options_.signals) source.queue->want(false);
  if (!file_.failed()) name_sources();
  return file_.finish();
}

}  // namespace neritic::testbed
