// The grid kind's part of current.cpp. World frame; pure functions, any thread.
#pragma once

#include "engine/sim/current.hpp"

namespace neritic::sim {

Status check_grid(const GridCurrent& current);
CurrentSample sample_grid(const GridCurrent& current, const Vec3& position_m, double time_s);

}  // namespace neritic::sim
