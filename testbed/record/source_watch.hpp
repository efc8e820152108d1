// Tells an operator when the authority over a group of inputs changes: its source falls silent, is
// heard again, or the group is handed over. One thread.
#pragma once

#include <string>
#include <vector>

#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

class SourceWatch {
 public:
  // Borrows both.
  SourceWatch(const PhysicsWorld& world, const SampleInbox& inbox);

  // Newer states than before, not necessarily each. A line a change: "12.50 s: diver: body: suit is
  // silent, autopilot acts". Allocates only for a change.
  std::vector<std::string> changes(const sim::Snapshot<PhysicsState>& snapshot);

 private:
  const PhysicsWorld& world_;
  const SampleInbox& inbox_;
  std::vector<std::array<GroupState, kVehicleGroups>> vehicles_;  // as last told
  std::vector<std::array<GroupState, kDiverGroups>> humans_;
};

}  // namespace neritic::testbed
