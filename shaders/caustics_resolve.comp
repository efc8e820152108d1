#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Sums of the rays' energy as light over that under flat water, smoothed over 3 x 3 texels, so that rays that part
// leave no gaps.
#include "shared/caustics.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kCausticsParams, scalar) uniform Params { CausticsParams params; };
layout(set = 0, binding = kCausticsSums, scalar) readonly buffer Sums { uint sums[]; };
layout(set = 0, binding = kCausticsOut, rgba16f) writeonly uniform image2DArray out_image;

// One after or before a place from 0 to n - 1, round the tile's end.
uint after(uint at, uint n) { return at + 1u < n ? at + 1u : 0u; }
uint before(uint at, uint n) { return at > 0u ? at - 1u : n - 1u; }

float smoothed(uint level, uint n, uvec2 at) {
  uint columns[3] = {before(at.x, n), at.x, after(at.x, n)};
  uint rows[3] = {before(at.y, n), at.y, after(at.y, n)};
  uint sum = 0u;
  [[unroll]] for (uint y = 0u; y < 3u; ++y)
    [[unroll]] for (uint x = 0u; x < 3u; ++x) {
      uint weight = (2u - (x & 1u ^ 1u)) * (2u - (y & 1u ^ 1u));
      sum += weight * sums[(level * n + rows[y]) * n + columns[x]];
    }
  return float(sum) / float(16u * kCausticPart * kCausticPart);
}

void main() {
  // Read before any branch (shared/even.glsl).
  uint n = params.texels, first_level = params.first_level, end_level = params.end_level;
  uvec3 at = gl_GlobalInvocationID;
  at.z += first_level / kCausticLayerStep;
  if (at.x >= n || at.y >= n) return;
  vec4 light = vec4(1.0);
  uint base = at.z * kCausticLayerStep;
  for (uint level = max(base, first_level); level < min(base + 4u, end_level); ++level)
    light = mix(light, vec4(smoothed(level, n, at.xy)), equal(uvec4(0u, 1u, 2u, 3u), uvec4(level - base)));
  imageStore(out_image, ivec3(at), light);
}
