// A dive with a display as a World for programs: what its physics gives goes from the stepping
// thread to the loop's, which lets its world answer in each frame. Made before the loop, whose step
// sinks and sources it joins; borrowed by it.
#pragma once

#include <functional>
#include <mutex>

#include "testbed/record/step_sink.hpp"
#include "testbed/samples/source.hpp"
#include "testbed/world/world.hpp"

namespace neritic::testbed {

class DiveLink final : public StepSink, public SampleSource {
 public:
  // While frames are slower than these, the oldest half goes; World::dropped() counts them.
  static constexpr std::size_t kMostWaiting = 1 << 15;

  // Borrows all; devices: null where the scene's are not listened to.
  static Result<std::unique_ptr<DiveLink>> create(LivePhysics& physics, const scene::Scene& scene,
                                                  const std::string& path, const Devices* devices);

  // The loop's thread.
  World& world() { return *world_; }
  // In each frame, after the world has received what is new.
  void each_turn(std::function<void()> act) { act_ = std::move(act); }
  Status poll(SampleInbox& inbox, double scene_time_s) override;

  std::vector<StreamId> streams() const override { return outputs_; }
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override;
  Status finish() override { return {}; }

 private:
  DiveLink(const LivePhysics& physics, std::unique_ptr<World> world);

  std::unique_ptr<World> world_;
  std::vector<StreamId> outputs_;
  std::function<void()> act_;
  std::vector<Sample> taken_;  // the loop's
  std::mutex mutex_;           // of what follows
  std::vector<Sample> waiting_;
  std::uint64_t missed_ = 0;  // dropped since the last poll
};

}  // namespace neritic::testbed
