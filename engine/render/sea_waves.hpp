// A sea's waves as the shaders see them, relative to a view set's origin at a time. Pure function;
// any thread.
#pragma once

#include "engine/core/sea_waves.hpp"
#include "shared/waves.h"

namespace neritic::render {

shared::Waves gpu_waves(const SeaWaves& sea, const Vec3& origin_m, double time_s);

}  // namespace neritic::render
