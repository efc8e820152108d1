// Marine axes and the program's, under the vehicle's names (engine/core/marine_frames.hpp).
#pragma once

#include "engine/core/marine_frames.hpp"

namespace neritic::rov {

using neritic::ned_from_world;
using neritic::world_from_ned;
using neritic::world_pose;

}  // namespace neritic::rov
