// A hash of what a scene's physics is built from: files, bodies, missions, currents, solid things.
// States are saved with it, so that none goes on in another scene. What does not move by physics
// and is in nobody's way (cameras, sonars, lamps, water colour) does not count.
#pragma once

#include <cstdint>

#include "engine/scene/scene.hpp"

namespace neritic::testbed {

// kBadInput where a file that the physics reads cannot be read.
Result<std::uint64_t> scene_hash(const scene::Scene& scene);

}  // namespace neritic::testbed
