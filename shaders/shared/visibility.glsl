// The visibility image: how its alpha tells distances. GLSL only.
#ifndef NERITIC_VISIBILITY_GLSL
#define NERITIC_VISIBILITY_GLSL
#include "shared/visibility.h"

// 5 cm to 600 m, evenly by octaves: in 8 bits each step is 3.8 %.
float visibility_distance(float planar_m) { return clamp((log2(max(planar_m, 1e-3)) + 4.3) / 13.6, 0.0, 1.0); }

#endif
