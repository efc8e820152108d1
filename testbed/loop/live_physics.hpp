// A scene's physics beside a picture that is being drawn: on a thread of its own at the clock's
// pace, or in lock-step with the picture's time. The thread that draws owns this and calls all of
// it.
#pragma once

#include <memory>
#include <optional>

#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

class LivePhysics {
 public:
  enum class Pace { kClock, kPicture };
  // Errors as PhysicsWorld::create. Precondition: PhysicsWorld::needed(scene).
  static Result<std::unique_ptr<LivePhysics>> create(const scene::Scene& scene, Pace pace);
  ~LivePhysics();

  // Time 0 is now.
  void start();
  // Puts the vehicles and divers of the scene where they are at that time: the host clock's, or, in
  // lock-step, seconds since start().
  void place(scene::Scene& scene, TimeNs display_ns, double time_s);
  // Of a pilot, from the next step on. False where a number is not finite.
  bool steer(std::size_t vehicle, const VehicleInputs& inputs);

  const PhysicsWorld& world() const { return *world_; }
  // What place() last showed.
  const PhysicsState& shown() const { return shown_; }
  Pose pose(std::size_t vehicle) const;
  sim::StepPacer::Counts counts() const { return simulation_->pace(); }
  // Lock-step only.
  const sim::Snapshot<PhysicsState>& newest() const { return simulation_->newest(); }

 private:
  LivePhysics(std::unique_ptr<const PhysicsWorld> world, Pace pace);

  std::unique_ptr<const PhysicsWorld> world_;
  Pace pace_;
  sim::HostClock clock_;
  std::unique_ptr<PhysicsSimulation> simulation_;
  sim::SnapshotReader<PhysicsState> reader_;
  PhysicsState shown_;
};

}  // namespace neritic::testbed
