// Hashes of what a scene's physics reads of a model (scene_hash.hpp). Pure functions; any thread.
#pragma once

#include <cstdint>

#include "engine/scene/model.hpp"

namespace neritic::testbed {

// Vertices at rest and triangles: outlines of what moves, shapes of what is solid; and the nodes on
// which a diver's joints and a vehicle's outline stand.
std::uint64_t shape_hash(const scene::Model& model, const Vec3& scale);
// The nodes with all that poses them: where things are that hang on a joint. clip: an index, or -1.
std::uint64_t joints_hash(const scene::Model& model, int clip);

}  // namespace neritic::testbed
