// Maps of values as pixels of a canvas. Pure functions; any thread.
#pragma once

#include <span>

#include "engine/draw2d/canvas.hpp"
#include "engine/draw2d/color_maps.hpp"

namespace neritic::draw2d {

// values[rows][columns] on width x height pixels, each pixel the mean of the area it covers. NaN
// values are left out; a pixel that covers nothing else is NaN. CHECKs that the sizes match and
// are not zero.
ImageF32 resample_area(std::span<const float> values, std::size_t rows, std::size_t columns,
                       std::uint32_t width, std::uint32_t height);

// Shades (0 to 1, one channel) in a map's colours, the first at (left, top); NaN leaves the
// background.
void draw_shades(Canvas& canvas, int left, int top, const ImageF32& shades, ColorMap map);

}  // namespace neritic::draw2d
