// The colour of a glowing black body. Pure.
#pragma once

#include "engine/core/math.hpp"

namespace neritic::scene {

// Linear sRGB of luminance 1 (0.2126 R + 0.7152 G + 0.0722 B), so that candela and lumen stay what
// they are; a channel may exceed 1. A body of 6504 K is white, [1, 1, 1]. Chromaticity of the
// Planckian locus by Kim et al. 2002 (US patent 7024034, cubic splines, 1667 to 25000 K; beyond
// these the nearer end), sRGB's matrix (IEC 61966-2-1), each channel over its value at 6504 K.
Vec3f color_of_temperature(double kelvin);

}  // namespace neritic::scene
