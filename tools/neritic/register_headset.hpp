// The lab's side of marked places, from a headset that is held at each of them in turn.
#pragma once

#include <vector>

#include "engine/core/registration.hpp"

namespace neritic::tools {

// Fills from_m of each pair, in their order: the mean of a second and a half in which the headset
// was still, at least 0.2 m from the place before. Says on standard error which place is next.
// kInterrupted on Ctrl+C; errors as Headset::connect; kUnsupported where the runtime has no room
// (STAGE), or ends.
Status measure_by_headset(std::vector<PointPair>& pairs);

}  // namespace neritic::tools
