// A scene's physics beside what shows and hears it: on a thread of its own at a clock's pace, or in
// lock-step with the times asked for. Keeps the history that says where everything is. The thread
// that draws owns this and calls all of it.
#pragma once

#include <functional>
#include <memory>

#include "testbed/motion/motion_history.hpp"
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
  // Takes what is known up to the time of a picture: in lock-step it steps to time_s, else it asks
  // the thread what is new and ignores time_s. Returns the scene time of the picture, which stands
  // still while the thread drops steps and never falls.
  double follow(TimeNs display_ns, double time_s);
  // Lock-step: steps until the state of time_s is known, and keeps the states of a short while
  // before it; what was kept for the last such time stays. second: called after each second.
  void reach(double time_s, const std::function<void()>& second = {});
  // Where samples enter; any thread. They count from the next step on.
  SampleInbox& inbox() { return simulation_->inbox(); }

  const PhysicsWorld& world() const { return *world_; }
  const MotionHistory& motion() const { return history_; }
  // The newest state that follow() found, and a vehicle's pose at the time that it returned.
  const PhysicsState& shown() const { return reader_.newest().state; }
  const sim::Snapshot<PhysicsState>& shown_snapshot() const { return reader_.newest(); }
  Pose pose(std::size_t vehicle) const;
  sim::StepPacer::Counts counts() const { return simulation_->pace(); }
  // Lock-step only.
  const sim::Snapshot<PhysicsState>& newest() const { return simulation_->newest(); }

 private:
  LivePhysics(std::unique_ptr<const PhysicsWorld> world, Pace pace);
  double follow_thread(TimeNs display_ns);

  std::unique_ptr<const PhysicsWorld> world_;
  Pace pace_;
  sim::HostClock clock_;
  std::unique_ptr<PhysicsSimulation> simulation_;
  sim::SnapshotReader<PhysicsState> reader_;
  MotionHistory history_;
  double shown_s_ = 0.0;
};

}  // namespace neritic::testbed
