// The visibility image: how its alpha tells pixels apart. GLSL only.
#ifndef NERITIC_VISIBILITY_GLSL
#define NERITIC_VISIBILITY_GLSL
#include "shared/visibility.h"

// 5 cm to 600 m, evenly by octaves: in 7 bits each step is 7.7 %.
float visibility_distance(float planar_m) { return clamp((log2(max(planar_m, 1e-3)) + 4.3) / 13.6, 0.0, 1.0); }

// What tells the image's pixels apart: the distance, and whether the sun is on that side of the surface, which counts as
// half of all distances. The sun's shadow on a face that is turned away from it means nothing: mixed into the ground
// at its foot it would light a line between a hull and its shadow.
float visibility_key(float planar_m, vec3 normal, vec3 to_sun) {
  return 0.5 * visibility_distance(planar_m) + (dot(normal, to_sun) > 0.0 ? 0.0 : 0.5);
}

#endif
