// Tells an operator when the authority over a group of inputs changes: its source falls silent, is
// heard again, or the group is handed over. One thread.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "testbed/record/step_sink.hpp"

namespace neritic::testbed {

class SourceWatch final : public StepSink {
 public:
  // Gets a line a change: "12.50 s: diver: body: suit is silent, autopilot acts".
  using Tell = std::function<void(const std::string& line)>;
  // Borrows both.
  SourceWatch(const PhysicsWorld& world, const SampleInbox& inbox, Tell tell);

  // Steps may be left out. Allocates only for a change.
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override;
  Status finish() override { return {}; }

 private:
  const PhysicsWorld& world_;
  const SampleInbox& inbox_;
  Tell tell_;
  std::vector<std::array<GroupState, kVehicleGroups>> vehicles_;  // as last told
  std::vector<std::array<GroupState, kDiverGroups>> humans_;
  std::vector<std::array<GroupState, kObjectGroups>> objects_;
};

}  // namespace neritic::testbed
