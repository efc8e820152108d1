// The water's motion along the way of something in a step. Pure function; any thread. North, east,
// down.
#pragma once

#include <optional>

#include "diver/motion.hpp"
#include "engine/core/sea_waves.hpp"
#include "engine/sim/current.hpp"

namespace neritic::testbed {

// The current and the waves' flow where the thing will be half way through the step, how that
// changes on its way, and the water's own acceleration: to second order in the step. Without both
// the water rests. A grid may jump within the thing's own length: that is no acceleration of all
// the water around.
diver::WaterFlow water_along(const std::optional<sim::Current>& current,
                             const std::optional<SeaWaves>& waves, const Vec3& position_ned_m,
                             const Vec3& velocity_ned_m_s, double time_s, double dt_s);

}  // namespace neritic::testbed
