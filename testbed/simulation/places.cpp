#include "testbed/simulation/places.hpp"

#include "diver/frames.hpp"

namespace neritic::testbed {
namespace {

scene::Mount mount_of(const scene::Aim& aim) {
  if (aim.object >= 0) return {.object = aim.object};
  return {.pose = {aim.point_m, Quat(1.0, 0.0, 0.0, 0.0)}};
}

}  // namespace

Place::Place(const scene::Scene& scene, const scene::Aim& aim, const Movers& movers)
    : thing_(scene, mount_of(aim)), movers_(movers) {
  if (aim.object >= 0) human_ = movers.human_of_object[static_cast<std::size_t>(aim.object)];
}

Motion Place::motion(const PhysicsState& state, double time_s) const {
  const StateMotion simulated(movers_, state);
  return thing_.at(time_s, &simulated).motion;
}

Quat Place::facing(const PhysicsState& state, double time_s) const {
  if (human_ < 0) return at(state, time_s).rotation;
  const diver::RootState& root = state.humans()[static_cast<std::size_t>(human_)].human.root;
  return world_pose(root.position_ned_m, root.attitude).rotation;
}

}  // namespace neritic::testbed
