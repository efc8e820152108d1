// Whether the sun's beam reaches a place past the solids of its maps. GLSL only. The including file declares `sun`,
// of type VisibilityParams, cascade_image and the constant kCascades.
#ifndef NERITIC_SUN_BEAM_GLSL
#define NERITIC_SUN_BEAM_GLSL
#include "shared/visibility.h"

// Whether the sun's beam reaches a place: 1 or 0.
float sun_reaches(vec3 position) {
  float seen = 1.0;
  bool found = false;
  [[unroll]] for (uint c = 0u; c < kCascades; ++c) {
    vec4 clip = sun.cascades[c].clip_from_origin * vec4(position, 1.0);
    vec2 at = clip.xy / clip.w;
    if (found || max(abs(at.x), abs(at.y)) >= 0.999) continue;
    found = true;
    int size = textureSize(cascade_image, 0).x;
    ivec2 texel = clamp(ivec2((at * 0.5 + 0.5) * float(size)), ivec2(0), ivec2(size - 1));
    float depth = texelFetch(cascade_image, ivec3(texel, c), 0).r;
    seen = depth * (clip.w - 0.03) > sun.cascades[c].near_m ? 0.0 : 1.0;
  }
  return seen;
}

#endif
