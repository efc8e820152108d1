// Everything that moves or watches in a scene, by name: vehicles, divers, objects with a track, a
// clip or inputs (or carried by one that moves), cameras, sonars; and where each is at a time. A
// school that mills round its place is none. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/motion.hpp"

namespace neritic::testbed {

struct Participant {
  std::string name;
  const char* kind = "";  // "vehicle", "diver", "object", "camera" or "sonar"
  scene::Mount mount;     // of it, or on the object that it is
};

// Objects first, in the scene's order; then cameras, then sonars.
std::vector<Participant> participants_of(const scene::Scene& scene);

// World_from_participant, in the order of participants_of the motion's scene.
std::vector<scene::MotionAt> motions_of(const std::vector<Participant>& participants,
                                        const scene::MotionSource& motion, double time_s);

}  // namespace neritic::testbed
