// Where the objects are that missions speak of, by the one source of motion
// (engine/scene/motion.hpp) out of a state. Built once, then only read; any thread. World frame.
#pragma once

#include "testbed/simulation/object_motion.hpp"

namespace neritic::testbed {

class Place {
 public:
  // Borrows movers.
  Place(const scene::Scene& scene, const scene::Aim& aim, const Movers& movers);

  Pose at(const PhysicsState& state, double time_s) const { return motion(state, time_s).pose; }
  Vec3 velocity_m_s(const PhysicsState& state, double time_s) const {
    return motion(state, time_s).velocity_m_s;
  }
  // With -z ahead: a diver's head, where at() has the axes of the model, which stands.
  Quat facing(const PhysicsState& state, double time_s) const;

 private:
  Motion motion(const PhysicsState& state, double time_s) const;

  scene::CarriedThing thing_;
  const Movers& movers_;
  int human_ = -1;  // the diver that it is
};

}  // namespace neritic::testbed
