#include "testbed/record/recording_switch.hpp"

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
  Files(const PhysicsWorld& world, const SampleInbox& inbox, const std::filesystem::path& base)
      : recording_(world, inbox, with(base, ".log")), csv_(world, 0.0, rows(world, base)) {}

  Status use(const Sample& sample) override { return recording_.use(sample); }
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override {
    NERITIC_TRY_STATUS(recording_.accept(step, outputs));
    return csv_.accept(step, outputs);
  }
  Status finish() override {
    const Status recorded = recording_.finish(), logged = csv_.finish();
    return recorded.ok() ? logged : recorded;
  }

 private:
  static std::vector<std::unique_ptr<RowSink>> rows(const PhysicsWorld& world,
                                                    const std::filesystem::path& base) {
    std::vector<std::unique_ptr<RowSink>> out;
    out.push_back(std::make_unique<CsvLog>(world, with(base, ".csv")));
    return out;
  }

  RecordingFile recording_;
  DiveLog csv_;
};

Status RecordingSwitch::begin(const PhysicsSimulation& simulation, std::filesystem::path base) {
  NERITIC_CHECK(!files_, "{} is being recorded", log_.string());
  const StateFormat format = world_.state_format();
  if (simulation.newest().step > 0)
    NERITIC_TRY_STATUS(write_state(with(base, ".state"), format, saved_state(simulation, format)));
  files_ = std::make_unique<Files>(world_, simulation.inbox(), base);
  log_ = with(base, ".log");
  begun_s_ = simulation.newest().time_s;
  failed_ = false;
  return accept(simulation.newest(), {});
}

std::unique_ptr<StepSink> RecordingSwitch::end() {
  return std::move(files_);
}

Status RecordingSwitch::use(const Sample& sample) {
  if (files_ && !failed_) failed_ = !files_->use(sample).ok();
  return {};
}

Status RecordingSwitch::accept(const sim::Snapshot<PhysicsState>& step,
                               std::span<const Sample> outputs) {
  if (files_ && !failed_) failed_ = !files_->accept(step, outputs).ok();
  return {};
}

}  // namespace neritic::testbed
