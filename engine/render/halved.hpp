// Pictures of half the size, for the mips of a texture. Pure functions; any thread.
#pragma once

#include "engine/core/image.hpp"

namespace neritic::render {

// Half as wide and high (at least 1), each pixel the mean of those it covers. The mean of sRGB
// colour is taken of its squares, which are nearly linear.
ImageU8 halved(const ImageU8& image, bool srgb);

}  // namespace neritic::render
