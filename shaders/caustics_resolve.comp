#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Sums of the rays' energy as light over that under flat water, smoothed over 3 x 3 texels, so that rays that part
// leave no gaps.
#include "shared/caustics.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kCausticsParams, scalar) uniform Params { CausticsParams params; };
layout(set = 0, binding = kCausticsSums, scalar) readonly buffer Sums { uint sums[]; };
layout(set = 0, binding = kCausticsOut, rgba16f) writeonly uniform image2DArray out_image;

float smoothed(uint level, uvec2 at) {
  uint n = params.texels;
  uint sum = 0u;
  for (uint y = 0u; y < 3u; ++y)
    for (uint x = 0u; x < 3u; ++x) {
      uint weight = (2u - (x & 1u ^ 1u)) * (2u - (y & 1u ^ 1u));
      sum += weight * sums[(level * n + (at.y + n + y - 1u) % n) * n + (at.x + n + x - 1u) % n];
    }
  return float(sum) / float(16u * kCausticPart * kCausticPart);
}

void main() {
  uvec3 at = gl_GlobalInvocationID;
  at.z += params.first_level / kCausticLayerStep;
  uint n = params.texels;
  if (at.x >= n || at.y >= n) return;
  vec4 light = vec4(1.0);
  uint base = at.z * kCausticLayerStep;
  for (uint level = max(base, params.first_level); level < min(base + 4u, params.end_level); ++level)
    light = mix(light, vec4(smoothed(level, at.xy)), equal(uvec4(0u, 1u, 2u, 3u), uvec4(level - base)));
  imageStore(out_image, ivec3(at), light);
}
