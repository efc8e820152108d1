// Polygons as coverage: each pixel gets the exact area that the polygon covers of it. Pure.
#pragma once

#include <span>

#include "engine/core/math.hpp"
#include "engine/draw2d/mask.hpp"

namespace neritic::draw2d {

// A closed polygon in pixels, y down. Pixels outside clip are left out; corners may lie anywhere.
// A corner that is not finite gives an empty mask.
Mask polygon_mask(std::span<const Vec2> corners, const PixelBox& clip);

}  // namespace neritic::draw2d
