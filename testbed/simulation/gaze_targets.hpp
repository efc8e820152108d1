// The things of a scene about a line of sight: whom or what a diver looks at. Built once, then only
// read; any thread. World frame.
#pragma once

#include <vector>

#include "engine/sim/static_world.hpp"
#include "testbed/simulation/object_motion.hpp"

namespace neritic::testbed {

class GazeTargets {
 public:
  GazeTargets() = default;
  // Borrows movers. Things with a model of their own, but for beds and what stands in many copies.
  GazeTargets(const scene::Scene& scene, const Movers& movers);

  struct Seen {
    std::uint64_t object =
        0;                 // number of the scene's object, from 1 on; 0: nothing within kWithin_rad
    double off_rad = 0.0;  // of the line of sight from it, or from the nearest thing: 0 to pi
    double distance_m = 0.0;  // from the eyes to where the sight meets or passes it
    bool doubtful = false;    // the sight passes another as closely
  };
  static constexpr double kWithin_rad = radians(5.0);
  // gaze: unit. diver: the object whose eyes they are; it and what it carries are left out, as are
  // things behind something solid, and those that the eyes are within.
  Seen look(const PhysicsState& state, const sim::StaticWorld& solid, std::size_t diver,
            const Vec3& eyes_m, const Vec3& gaze, double time_s) const;

 private:
  struct Target {
    std::size_t object = 0;
    std::vector<std::size_t> carriers;
    scene::CarriedThing thing;
    scene::Bounds bounds;  // object's axes, metres
  };
  const Movers* movers_ = nullptr;
  std::vector<Target> targets_;
};

}  // namespace neritic::testbed
