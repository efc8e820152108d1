// The colour of a glowing black body. Pure.
#pragma once

#include "engine/core/math.hpp"

namespace neritic::scene {

// Linear sRGB of largest channel 1, over daylight of 6504 K, which is white: chromaticity of the
// Planckian locus by Kim et al. 2002 (US patent 7024034, cubic splines, 1667 to 25000 K), and
// sRGB's matrix (IEC 61966-2-1). Below 1667 K the spline of that.
Vec3f color_of_temperature(double kelvin);

}  // namespace neritic::scene
