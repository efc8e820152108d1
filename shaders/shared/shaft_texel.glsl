// A texel of the shafts image: the ratio, 0 to kShaftMost, and the sight's visibility_distance, 0 to 1, in one float,
// which processors read several times as fast as four halves: the distance in whole steps, the ratio behind the
// point. GLSL only.
#ifndef NERITIC_SHAFT_TEXEL_GLSL
#define NERITIC_SHAFT_TEXEL_GLSL

#include "shared/shafts.h"

float packed_shaft(float ratio, float distance) {
  return floor(distance * kShaftSteps + 0.5) + clamp(ratio / kShaftMost, 0.0, 0.9998);
}
vec2 unpacked_shaft(float texel) {
  float steps = floor(texel);
  return vec2((texel - steps) * kShaftMost, steps / kShaftSteps);
}

#endif
