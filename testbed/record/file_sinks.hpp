// The files that a run of physics leaves beside its recording: its log and its last state. Each is
// a step sink; what they borrow outlives them.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "testbed/record/csv_log.hpp"
#include "testbed/record/step_sink.hpp"

namespace neritic::testbed {

// Figures of the dive, and its rows for those who take them. A receiver of rows that fails gets no
// more; the run goes on: the failure is told once, and is what finish() returns.
class DiveLog final : public StepSink {
 public:
  // on_failure: the stepping thread; one line.
  DiveLog(const PhysicsWorld& world, double row_rate_hz, std::vector<std::unique_ptr<RowSink>> rows,
          std::function<void(const std::string&)> on_failure = {})
      : world_(world),
        options_{.rows = !rows.empty(), .row_rate_hz = row_rate_hz},
        recorder_(std::in_place, world, options_),
        rows_(std::move(rows)),
        failed_(rows_.size()),
        on_failure_(std::move(on_failure)) {}
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override;
  Status finish() override;
  // The stepping thread: a receiver of rows failed.
  bool failed() const;
  const DiveRecorder& recorder() const { return *recorder_; }

 private:
  const PhysicsWorld& world_;
  RecordOptions options_;
  std::optional<DiveRecorder> recorder_;  // begins anew if the run goes to a saved state
  bool begun_ = false;
  std::uint64_t last_step_ = 0;
  std::vector<std::unique_ptr<RowSink>> rows_;
  std::vector<bool> failed_;  // of rows_
  std::function<void(const std::string&)> on_failure_;
};

// The state after the last step, and the inputs that hold then.
class StateFile final : public StepSink {
 public:
  StateFile(const PhysicsWorld& world, const PhysicsSimulation& simulation,
            std::filesystem::path path)
      : world_(world), simulation_(simulation), path_(std::move(path)) {}
  Status accept(const sim::Snapshot<PhysicsState>&, std::span<const Sample>) override { return {}; }
  Status finish() override;

 private:
  const PhysicsWorld& world_;
  const PhysicsSimulation& simulation_;
  std::filesystem::path path_;
};

}  // namespace neritic::testbed
