#include "tools/neritic/step_files.hpp"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/core/refusal.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/dive_picture.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr double kMostRows_hz = 1e4;

// The rows of the log as a picture.
class DivePlot final : public StepSink {
 public:
  DivePlot(const PhysicsWorld& world, const DiveRecorder& recorder, std::string title,
           std::string path)
      : world_(world), recorder_(recorder), title_(std::move(title)), path_(std::move(path)) {}
  Status accept(const sim::Snapshot<PhysicsState>&, std::span<const Sample>) override { return {}; }
  Status finish() override {
    const auto drawn = write_picture(path_, dive_picture_data(title_, world_, recorder_));
    return drawn.ok() ? Status() : Status(drawn.error());
  }

 private:
  const PhysicsWorld& world_;
  const DiveRecorder& recorder_;
  std::string title_, path_;
};

}  // namespace

std::string first_step_flag(const StepFileFlags& flags) {
  if (!flags.log.empty()) return "--log";
  if (flags.log_rate_hz) return "--log-rate";
  if (!flags.plot.empty()) return "--plot";
  if (!flags.record.empty()) return "--record";
  if (!flags.save.empty()) return "--save";
  return "";
}

Error flag_without_physics(const std::string& flag, const std::string& scene) {
  return refusal(flag, fmt::format("{}, where nothing moves by physics", scene),
                 "a scene where a vehicle has dynamics or a diver swims");
}

Status check_step_files(const StepFileFlags& flags, const OutputFile& other) {
  const double rate_hz = flags.log_rate_hz.value_or(0.0);
  if (!(rate_hz >= 0.0 && rate_hz <= kMostRows_hz))
    return refusal("--log-rate", fmt::format("{}", rate_hz),
                   fmt::format("0 to {:g}", kMostRows_hz));
  std::vector<OutputFile> files{{"--log", flags.log},
                                {"--plot", flags.plot},
                                {"--record", flags.record},
                                {"--save", flags.save},
                                other};
  for (const OutputFile& one : files) NERITIC_TRY_STATUS(check_output_file(one.flag, one.file));
  if (!flags.plot.empty()) files.push_back({"--plot", picture_data_path(flags.plot)});
  return check_outputs_differ(files);
}

StepFiles::StepFiles(const StepFileFlags& flags, const std::string& title,
                     const LivePhysics& physics) {
  const PhysicsWorld& world = physics.world();
  if (!flags.save.empty())
    files_.push_back(std::make_unique<StateFile>(world, physics.simulation(), flags.save));
  if (!flags.record.empty())
    files_.push_back(std::make_unique<RecordingFile>(world, physics.simulation(), flags.record));
  auto log =
      std::make_unique<DiveLog>(world,
                                RecordOptions{.rows = !flags.log.empty() || !flags.plot.empty(),
                                              .row_rate_hz = flags.log_rate_hz.value_or(0.0)},
                                flags.log);
  log_ = log.get();
  files_.push_back(std::move(log));
  if (!flags.plot.empty())
    files_.push_back(std::make_unique<DivePlot>(world, log_->recorder(), title, flags.plot));
}

std::vector<StepSink*> StepFiles::sinks() const {
  std::vector<StepSink*> sinks;
  for (const auto& file : files_) sinks.push_back(file.get());
  return sinks;
}

Status StepProgress::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) {
  if (!begun_) {
    begun_ = true;
    told_s_ = step.time_s;
    const double seconds = std::ceil(until_s_ - told_s_);
    if (seconds > 0.0) progress_.emplace(what_, static_cast<std::uint64_t>(seconds));
  }
  if (!progress_) return {};
  for (; told_s_ + 1.0 <= step.time_s; told_s_ += 1.0) progress_->step();
  if (step.time_s >= until_s_) progress_.reset();
  return {};
}

Status StepProgress::finish() {
  progress_.reset();
  return {};
}

}  // namespace neritic::tools
