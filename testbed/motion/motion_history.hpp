// A bounded history of what a simulation moves, and where it was, is and will be at any time: the
// same answer for the live program and for pictures made later, bit for bit, where the two states
// around that time are the same. Times are scene time, in seconds. Plain value; one thread.
#pragma once

#include <optional>
#include <vector>

#include "engine/scene/motion.hpp"
#include "testbed/motion/trails.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// The objects that a simulation moves, at one instant, in the order of the history's objects.
struct MotionSnapshot {
  double time_s = 0.0;
  // World_from_object; nothing: the object's own track or place has it.
  std::vector<std::optional<Motion>> motions;
  // For the objects with nodes, in their order; without rotations: its clip moves it.
  std::vector<scene::NodeKey> joints;
};

class MotionHistory final : public scene::SimulatedMotion {
 public:
  struct Moved {
    std::size_t object = 0;  // of the scene
    std::vector<int> nodes;  // of its model that the simulation moves; empty: its clip moves it
  };
  // Snapshots kept: a tenth of a second at 240 steps a second lies in half of them.
  static constexpr std::size_t kKept = 64;
  static constexpr double kMostPredicted_s = 0.1;

  explicit MotionHistory(std::vector<Moved> moved, std::vector<FollowedPoint> followed = {});

  // Times rise; one that is not later than the newest is left out. The oldest makes room.
  void add(MotionSnapshot snapshot);
  // Whether trace() wants the state of that time; its times rise, too.
  bool trace_due(double time_s) const { return trails_.due(time_s); }
  // Notes where the followed points are, and keeps nothing else.
  void trace(MotionSnapshot snapshot, const Trails::Wash& wash);
  void clear();
  bool empty() const { return count_ == 0; }
  double newest_s() const { return at_age(0).time_s; }

  std::optional<scene::MotionAt> at(std::size_t object, double time_s) const override;
  std::optional<scene::ModelPose> model_pose(std::size_t object, const scene::Model& model,
                                             double time_s) const override;
  std::optional<Mat4> model_from_node(std::size_t object, const scene::Model& model, int node,
                                      double time_s) const override;
  std::optional<scene::FollowedPlace> followed(std::size_t object, int joint,
                                               const Vec3& position_m,
                                               double time_s) const override {
    return trails_.at(object, joint, position_m, time_s);
  }

 private:
  // The newest has age 0.
  const MotionSnapshot& at_age(std::size_t age) const {
    return ring_[(added_ - 1 - age) % ring_.size()];
  }
  std::size_t age_before(double time_s) const;
  // The keys of an object's nodes; nothing while its clip moves it.
  std::optional<scene::NodeKeys> keys_around(std::size_t object, const scene::Model& model,
                                             double time_s) const;

  std::vector<Moved> moved_;
  // By object of the scene: its place in moved_, and in a snapshot's joints; -1: none.
  std::vector<int> place_, joints_;
  std::vector<MotionSnapshot> ring_;
  std::size_t added_ = 0, count_ = 0;
  Trails trails_;
};

// The parts of a physics' states that the history keeps: vehicles, then divers, then objects that
// devices move.
std::vector<MotionHistory::Moved> moved_objects(const PhysicsWorld& world);
MotionSnapshot motion_of(const PhysicsWorld& world, const sim::Snapshot<PhysicsState>& snapshot);

}  // namespace neritic::testbed
