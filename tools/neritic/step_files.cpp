#include "tools/neritic/step_files.hpp"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/dive_picture.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr double kMostRows_hz = 1e4;

// Rows, thinned, as a picture.
class DivePlot final : public RowSink {
 public:
  DivePlot(const PhysicsWorld& world, std::string title, std::string path)
      : world_(world), rows_(world), title_(std::move(title)), path_(std::move(path)) {}
  Status accept(const DiveRows& rows) override {
    rows_.add(rows);
    return {};
  }
  Status finish() override {
    const auto drawn = write_picture(path_, dive_picture_data(title_, world_, rows_, *figures_));
    return drawn.ok() ? Status() : Status(drawn.error());
  }
  // Figures of the divers; before finish.
  void set_figures(const std::vector<HumanFigures>& figures) { figures_ = &figures; }

 private:
  const PhysicsWorld& world_;
  PlotRows rows_;
  std::string title_, path_;
  const std::vector<HumanFigures>* figures_ = nullptr;
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

Status check_step_files(const StepFileFlags& flags, const std::vector<OutputFile>& others) {
  const double rate_hz = flags.log_rate_hz.value_or(0.0);
  if (!(rate_hz >= 0.0 && rate_hz <= kMostRows_hz))
    return refusal("--log-rate", fmt::format("{}", rate_hz),
                   fmt::format("0 to {:g}", kMostRows_hz));
  if (flags.log_rate_hz && flags.log.empty() && flags.plot.empty())
    return refusal("--log-rate", "no --log beside it", "with --log or --plot");
  std::vector<OutputFile> files{{"--log", flags.log},
                                {"--plot", flags.plot},
                                {"--record", flags.record},
                                {"--save", flags.save}};
  files.insert(files.end(), others.begin(), others.end());
  for (const OutputFile& one : files) NERITIC_TRY_STATUS(check_output_file(one.flag, one.file));
  if (!flags.plot.empty()) files.push_back({"--plot", picture_data_path(flags.plot)});
  NERITIC_TRY_STATUS(check_outputs_differ(files));
  const std::string ending = std::filesystem::path(flags.record).extension().string();
  if (!ending.empty() && ending != ".mcap")
    return refusal("--record", fmt::format("'{}'", printable(flags.record)),
                   "an .mcap; of a dive also an .xdf");
  return {};
}

StepFiles::StepFiles(const StepFileFlags& flags, const std::string& title,
                     const RecordingOptions& recording, const LivePhysics& physics) {
  const PhysicsWorld& world = physics.world();
  if (!flags.save.empty())
    files_.push_back(std::make_unique<StateFile>(world, physics.simulation(), flags.save));
  if (!flags.record.empty()) {
    auto file =
        std::make_unique<RecordingFile>(world, physics.simulation(), flags.record, recording);
    recording_ = file.get();
    files_.push_back(std::move(file));
  }
  std::vector<std::unique_ptr<RowSink>> rows;
  DivePlot* plot = nullptr;
  if (!flags.log.empty()) rows.push_back(std::make_unique<CsvLog>(world, flags.log));
  if (!flags.plot.empty()) {
    rows.push_back(std::make_unique<DivePlot>(world, title, flags.plot));
    plot = static_cast<DivePlot*>(rows.back().get());
  }
  auto log = std::make_unique<DiveLog>(
      world, flags.log_rate_hz.value_or(0.0), std::move(rows),
      [](const std::string& line) { log_warn("{}; the run goes on without its log", line); });
  log_ = log.get();
  if (plot) plot->set_figures(log_->recorder().humans().figures());
  files_.push_back(std::move(log));
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
