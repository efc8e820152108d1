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

// A row's three texels about a column, the middle one twice.
uint across(uint level, uint n, uint row, uint columns[3]) {
  uint base = (level * n + row) * n;
  return sums[base + columns[0]] + 2u * sums[base + columns[1]] + sums[base + columns[2]];
}

void main() {
  // Read before any branch (shared/even.glsl).
  uint n = params.texels, first_level = params.first_level, end_level = params.end_level;
  // kCausticRows rows a lane: each row of sums is read for three of them.
  uvec3 at = gl_GlobalInvocationID * uvec3(1u, kCausticRows, 1u);
  at.z += first_level / kCausticLayerStep;
  if (at.x >= n || at.y >= n) return;
  uint columns[3] = {before(at.x, n), at.x, after(at.x, n)};
  vec4 light[kCausticRows];
  [[unroll]] for (uint y = 0u; y < kCausticRows; ++y) light[y] = vec4(1.0);
  uint base = at.z * kCausticLayerStep;
  for (uint level = max(base, first_level); level < min(base + 4u, end_level); ++level) {
    bvec4 own = equal(uvec4(0u, 1u, 2u, 3u), uvec4(level - base));
    uint row = at.y;
    uint above = across(level, n, before(row, n), columns), here = across(level, n, row, columns);
    [[unroll]] for (uint y = 0u; y < kCausticRows; ++y) {
      row = after(row, n);
      uint below = across(level, n, row, columns);
      light[y] = mix(light[y], vec4(float(above + 2u * here + below) / float(16u * kCausticPart * kCausticPart)), own);
      above = here;
      here = below;
    }
  }
  [[unroll]] for (uint y = 0u; y < kCausticRows; ++y)
    if (at.y + y < n) imageStore(out_image, ivec3(at.x, at.y + y, at.z), light[y]);
}
