// Where the fish of a school are, as a function of time alone: no state from frame to frame, so
// that any instant can be asked for in any order, with the same bits on any number of threads.
// World frame, metres; any thread.
#pragma once

#include <vector>

#include "engine/scene/motion.hpp"

namespace neritic::scene {

// object_from_copy of each fish of an object with a flock. A fish heads where it swims, facing -z.
std::vector<Mat4> flock_copies(const MotionSource& source, std::size_t object, double time_s);

}  // namespace neritic::scene
