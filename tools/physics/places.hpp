// Where the objects are that missions speak of: by their tracks, or by the simulation where they
// move by physics. Built once, then only read; any thread. World frame.
#pragma once

#include <vector>

#include "engine/scene/scene.hpp"
#include "tools/physics/physics_state.hpp"

namespace neritic::tools {

// One thing: what carries it, outermost last.
class Place {
 public:
  // vehicle_of_object: index of the object's vehicle, -1 where it has no dynamics.
  Place(const scene::Scene& scene, const scene::Aim& aim,
        const std::vector<int>& vehicle_of_object);

  Pose at(const PhysicsState& state, double time_s) const;
  Vec3 velocity_m_s(const PhysicsState& state, double time_s) const;

 private:
  std::vector<scene::Mount> chain_;  // itself first; each in the frame of the next
  int vehicle_ = -1;                 // what the last of the chain is mounted on; -1: the world
};

}  // namespace neritic::tools
