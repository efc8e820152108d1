#include "testbed/motion/live_physics.hpp"

#include <algorithm>

#include "testbed/motion/snapshot_motion.hpp"

namespace neritic::testbed {

LivePhysics::LivePhysics(std::unique_ptr<const PhysicsWorld> world, Pace pace)
    : world_(std::move(world)),
      pace_(pace),
      simulation_(world_->simulation({.log = false})),
      reader_(simulation_->reader()),
      history_(moved_objects(*world_)) {
  history_.add(motion_of(*world_, simulation_->newest()));
}

Result<std::unique_ptr<LivePhysics>> LivePhysics::create(const scene::Scene& scene, Pace pace) {
  NERITIC_TRY(auto world, PhysicsWorld::create(scene));
  return std::unique_ptr<LivePhysics>(new LivePhysics(std::move(world), pace));
}

LivePhysics::~LivePhysics() {
  simulation_->stop();
}

void LivePhysics::start() {
  if (pace_ == Pace::kClock) simulation_->start(clock_);
}

void LivePhysics::reach(double time_s, const std::function<void()>& second) {
  // Half of the history: the other half holds what was kept for the time before.
  const double kept_s = (MotionHistory::kKept / 2 - 1) * world_->step_s();
  while (simulation_->newest().time_s < time_s) {
    const double before_s = simulation_->newest().time_s;
    simulation_->advance(1);
    const auto& newest = simulation_->newest();
    if (newest.time_s > time_s - kept_s) history_.add(motion_of(*world_, newest));
    if (second && std::floor(newest.time_s) > std::floor(before_s)) second();
  }
}

double LivePhysics::follow(TimeNs display_ns, double time_s) {
  if (pace_ == Pace::kPicture) reach(time_s);
  reader_.update();
  const double now_s = pace_ == Pace::kPicture ? time_s : follow_thread(display_ns);
  shown_s_ = std::max(shown_s_, now_s);
  return shown_s_;
}

double LivePhysics::follow_thread(TimeNs display_ns) {
  if (reader_.newest().step == 0) return 0.0;
  history_.add(motion_of(*world_, reader_.previous()));
  history_.add(motion_of(*world_, reader_.newest()));
  return reader_.newest().time_s + 1e-9 * static_cast<double>(display_ns - reader_.newest().due_ns);
}

Pose LivePhysics::pose(std::size_t vehicle) const {
  return history_.at(world_->vehicles()[vehicle].object, shown_s_)->motion.pose;
}

}  // namespace neritic::testbed
