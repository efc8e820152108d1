// The waves of a tile of the surface that throws caustics, as the passes take them. Plain data made
// on the CPU; any thread.
#pragma once

#include <cstdint>
#include <utility>

#include "engine/scene/scene_light.hpp"
#include "shared/caustics.h"

namespace neritic::render {

// to_sun_air: unit, above the surface. Named waves, or by the wind 24 of 3 m to 0.12 m (as long as
// the tile lets) with equal shares of half of Cox and Munk's mean square slope (1954: 0.003 +
// 0.00512 U), the half of that range; phases and directions (within 60 degrees of the wind) by the
// seed. Each is bent to the nearest that repeats in the tile, and moves as a deep-water wave with
// surface tension (7.4e-5 m^3/s^2).
shared::CausticsParams caustics_params(const scene::Caustics& caustics, const Vec3& to_sun_air,
                                       double time_s, std::uint64_t seed);

// The levels, first and end, that shade surfaces between two depths; all where the depths are no
// range.
std::pair<std::uint32_t, std::uint32_t> caustic_levels(double least_depth_m, double most_depth_m);

}  // namespace neritic::render
