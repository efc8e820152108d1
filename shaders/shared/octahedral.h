// Unit vectors as two numbers in [-1, 1]: octahedral map (Meyer et al. 2010; Cigolle et al. 2014,
// "A Survey of Efficient Representations for Independent Unit Vectors"). With 16-bit
// signed-normalised storage the worst angular error is about 5e-5 rad.
#ifndef NERITIC_SHARED_OCTAHEDRAL_H
#define NERITIC_SHARED_OCTAHEDRAL_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// n need not be of length 1, but not zero.
NERITIC_INLINE vec2 octahedral_encode(vec3 n) {
  float s = 1.0f / (abs(n.x) + abs(n.y) + abs(n.z));
  float x = n.x * s;
  float y = n.y * s;
  if (n.z < 0.0f) {
    float folded_x = (1.0f - abs(y)) * (x >= 0.0f ? 1.0f : -1.0f);
    float folded_y = (1.0f - abs(x)) * (y >= 0.0f ? 1.0f : -1.0f);
    x = folded_x;
    y = folded_y;
  }
  return vec2(x, y);
}

NERITIC_INLINE vec3 octahedral_decode(vec2 e) {
  vec3 n = vec3(e.x, e.y, 1.0f - abs(e.x) - abs(e.y));
  if (n.z < 0.0f) {
    float x = (1.0f - abs(n.y)) * (n.x >= 0.0f ? 1.0f : -1.0f);
    float y = (1.0f - abs(n.x)) * (n.y >= 0.0f ? 1.0f : -1.0f);
    n.x = x;
    n.y = y;
  }
  return normalize(n);
}

NERITIC_SHARED_END
#endif
