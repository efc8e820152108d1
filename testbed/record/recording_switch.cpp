#include "testbed/record/recording_switch.hpp"

#include "engine/core/growing_file.hpp"

namespace neritic::testbed {
namespace {

std::filesystem::path with(std::filesystem::path base, const char* extension) {
  base += extension;
  return base;
}

}  // namespace

// The two files that grow.
class RecordingSwitch::Files final : public StepSink {
 public:
  Files(const PhysicsWorld& world, const PhysicsSimulation& simulation,
        const std::filesystem::path& base, RecordingOptions options)
      : recording_(world, simulation, with(base, ".mcap"), std::move(options)),
        csv_(world, 0.0, rows(world, base)),
        outputs_(world, recording_.streams()) {}
  bool failed() const { return recording_.failed() || csv_.failed(); }

  Status use(const Sample& sample) override { return recording_.use(sample); }
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) override {
    NERITIC_TRY_STATUS(recording_.accept(step, outputs_.of(step)));
    return csv_.accept(step, {});
  }
  Status finish() override {
    const Status recorded = recording_.finish(), logged = csv_.finish();
    return recorded.ok() ? logged : recorded;
  }

 private:
  static std::vector<std::unique_ptr<RowSink>> rows(const PhysicsWorld& world,
                                                    const std::filesystem::path& base) {
    std::vector<std::unique_ptr<RowSink>> out;
    keep_old(with(base, ".csv"));
    out.push_back(std::make_unique<CsvLog>(world, with(base, ".csv")));
    return out;
  }

  RecordingFile recording_;
  DiveLog csv_;
  OutputSamples outputs_;  // of the steps while it is on
};

RecordingSwitch::RecordingSwitch(const PhysicsWorld& world) : world_(world) {}

RecordingSwitch::~RecordingSwitch() = default;

void RecordingSwitch::begin(const PhysicsSimulation& simulation, std::filesystem::path base,
                            RecordingOptions options) {
  NERITIC_CHECK(!files_, "{} is being recorded", file_.string());
  files_ = std::make_unique<Files>(world_, simulation, base, std::move(options));
  file_ = with(base, ".mcap");
  begun_s_ = simulation.newest().time_s;
  failed_ = false;
  (void)accept(simulation.newest(), {});
}

std::unique_ptr<StepSink> RecordingSwitch::end() {
  return std::move(files_);
}

Status RecordingSwitch::finish() {
  return files_ ? end()->finish() : Status();
}

Status RecordingSwitch::use(const Sample& sample) {
  if (files_ && !failed_) failed_ = !files_->use(sample).ok();
  return {};
}

Status RecordingSwitch::accept(const sim::Snapshot<PhysicsState>& step,
                               std::span<const Sample> outputs) {
  if (files_ && !failed_) failed_ = !files_->accept(step, outputs).ok() || files_->failed();
  return {};
}

}  // namespace neritic::testbed
