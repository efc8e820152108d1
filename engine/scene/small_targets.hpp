// How small the smallest thing is that a sonar may meet, so that its samples can be laid closely
// enough to hear it in every ping. Pure function; any thread.
#pragma once

#include "engine/scene/scene.hpp"

namespace neritic::scene {

// The middle of the three extents of a model, of the object for which it is least: the width of a
// rod, the shorter side of a plate. Copies (plants, stones) and the sonar's own carrier do not
// count. 0: there is nothing.
double least_target_m(const Scene& scene, const Sonar& sonar);

}  // namespace neritic::scene
