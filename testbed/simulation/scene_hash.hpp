// A hash of what a scene's physics is built from: files, bodies, missions, currents, solid things,
// tracks, and the models and clips of what carries things on a joint.
// States are saved with it, so that none goes on in another scene. Things that neither move by
// physics nor collide (cameras, sonars, lamps, water colour) do not count.
#pragma once

#include <cstdint>
#include <span>

#include "engine/scene/scene.hpp"

namespace neritic::testbed {

// vehicle_files: the hash of each vehicle's file (vehicle_kinds.hpp). kBadInput if another file
// that the physics reads cannot be read.
Result<std::uint64_t> scene_hash(const scene::Scene& scene,
                                 std::span<const std::uint64_t> vehicle_files);

}  // namespace neritic::testbed
