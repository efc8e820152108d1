// Where the objects are that missions speak of: by their tracks, or by the simulation where they
// move by physics. Built once, then only read; any thread. World frame.
#pragma once

#include <vector>

#include "engine/scene/scene.hpp"
#include "testbed/simulation/physics_state.hpp"

namespace neritic::testbed {

// The objects that move by physics: index of an object's vehicle, or of its diver; -1: none.
struct Movers {
  std::vector<int> vehicle_of_object, human_of_object;
};

// One thing: what carries it, outermost last.
class Place {
 public:
  Place(const scene::Scene& scene, const scene::Aim& aim, const Movers& movers);

  Pose at(const PhysicsState& state, double time_s) const;
  // With -z ahead: a diver's head, where at() has the axes of the model, which stands.
  Quat facing(const PhysicsState& state, double time_s) const;
  Vec3 velocity_m_s(const PhysicsState& state, double time_s) const;

 private:
  std::vector<scene::Mount> chain_;  // itself first; each in the frame of the next
  // The mover that the last of the chain is mounted on; both -1: the world.
  int vehicle_ = -1, human_ = -1;
};

}  // namespace neritic::testbed
