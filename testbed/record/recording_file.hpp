// The recording of a run: a file (.mcap) with every sample that enters and leaves, the hash of each
// state, the scene's text and the state that it begins with. It is a step sink; a binding or a
// server gives it each step in the same way. If the file fails, the run goes on: the first failure
// is told once, and is what finish() returns.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "testbed/record/mcap_file.hpp"
#include "testbed/record/ros_outputs.hpp"
#include "testbed/record/step_sink.hpp"
#include "testbed/samples/sample_log.hpp"
#include "testbed/samples/signal_queue.hpp"

namespace neritic::testbed {

struct RecordingOptions {
  std::string scene_path;                      // as a replay finds it: absolute
  std::string scene_text;                      // empty: the recording has no scene
  std::optional<std::int64_t> recorded_at_ns;  // since 1970, of runs on a real clock
  // Any thread: one line, when the file fails.
  std::function<void(const std::string&)> on_failure;
  // A topic each, SOURCE/sound or SOURCE/ecg, which `neritic recording export` gives sample by
  // sample. The queues outlive the recording.
  std::vector<SignalSource> signals;
};
// The options of a scene that was read from a file. kBadInput if it cannot be read again.
Result<RecordingOptions> recording_of_scene(const std::filesystem::path& scene);

class RecordingFile final : public StepSink {
 public:
  // Begins with the simulation's newest state, which is saved in it if it is not the scene's start.
  // Not while its thread runs. Borrows the world, and the simulation's inbox.
  RecordingFile(const PhysicsWorld& world, const PhysicsSimulation& simulation,
                std::filesystem::path path, RecordingOptions options);

  std::vector<StreamId> streams() const override { return OutputSamples::all(world_); }
  Status use(const Sample& sample) override;
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override;
  Status finish() override;
  // Any thread: the file failed, so that it takes no more.
  bool failed() const { return file_.failed(); }
  // Where others add messages of their own: images, a server's clients. Any thread.
  recording::McapOut& out() { return file_; }
  bool ready() const { return file_.ready(); }

 private:
  void name_sources();
  void tell_failure();
  void write_signals(const sim::Snapshot<PhysicsState>& step);

  const PhysicsWorld& world_;
  const SampleInbox& inbox_;
  RecordingOptions options_;
  McapFile file_;
  SampleLogWriter log_;
  RosOutputs ros_;
  // Of options_.signals, from their first packet on.
  struct SignalChannel {
    std::optional<std::uint16_t> id;
    std::uint32_t sequence = 0;
  };
  std::vector<SignalChannel> signal_channels_;
  bool told_ = false;
};

}  // namespace neritic::testbed
