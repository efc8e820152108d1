#include "testbed/world/dive_link.hpp"

#include <algorithm>
#include <cmath>

#include "testbed/motion/live_physics.hpp"

namespace neritic::testbed {

DiveLink::DiveLink(const LivePhysics& physics, std::unique_ptr<World> world)
    : world_(std::move(world)), outputs_(OutputSamples::all(physics.world())) {}

Result<std::unique_ptr<DiveLink>> DiveLink::create(LivePhysics& physics, const scene::Scene& scene,
                                                   const std::string& path,
                                                   const Devices* devices) {
  NERITIC_TRY(auto world, World::attach(physics, scene, path, devices));
  return std::unique_ptr<DiveLink>(new DiveLink(physics, std::move(world)));
}

Status DiveLink::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) {
  if (outputs.empty()) return {};
  // Programs outside go by simulated time, samples by the host's clock.
  const TimeNs shift_ns = step.scene_from_host_ns();
  const std::lock_guard lock(mutex_);
  if (waiting_.size() + outputs.size() > kMostWaiting) {
    const std::size_t oldest = std::min(waiting_.size(), kMostWaiting / 2);
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(oldest));
    missed_ += oldest;
  }
  for (Sample sample : outputs) {
    sample.header.captured_ns += shift_ns;
    sample.header.arrived_ns += shift_ns;
    waiting_.push_back(sample);
  }
  return {};
}

Status DiveLink::poll(SampleInbox&, double) {
  taken_.clear();
  std::uint64_t missed = 0;
  {
    const std::lock_guard lock(mutex_);
    std::swap(taken_, waiting_);
    std::swap(missed, missed_);
  }
  world_->receive(taken_, missed);
  if (act_) act_();
  return {};
}

}  // namespace neritic::testbed
