#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

// A display picture of another size, no smaller: between the four nearest pixels. By fetches, of which a filtered
// sample on a CPU costs more than four; each invocation makes a block of pixels from the few that lie under it.
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kResizeIn) uniform texture2DArray in_image;
layout(set = 0, binding = kResizeOut, rgba8) writeonly uniform image2DArray out_image;

const uint kFrom = kResizeBlock + 1u;  // pixels of the source a side

// Shares that the source's pixels from first on have in pixel i: of two neighbours.
float[kFrom] shares_of(float i, float scale, float first) {
  float place = (i + 0.5) * scale - 0.5 - first, corner = floor(place), part = place - corner;
  // Steeper than linear between pixels: edges keep their contrast, flat gradients their slope.
  part = mix(part, part * part * (3.0 - 2.0 * part), 0.5);
  float shares[kFrom];
  [[unroll]] for (uint k = 0u; k < kFrom; ++k)
    shares[k] = float(k) == corner ? 1.0 - part : float(k) == corner + 1.0 ? part : 0.0;
  return shares;
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID) * ivec3(kResizeBlock, kResizeBlock, 1);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  ivec2 last = textureSize(in_image, 0).xy - 1;
  vec2 scale = vec2(last + 1) / vec2(size), first = floor((vec2(at.xy) + 0.5) * scale - 0.5);
  float columns[kResizeBlock][kFrom];
  [[unroll]] for (uint x = 0u; x < kResizeBlock; ++x) columns[x] = shares_of(float(at.x + int(x)), scale.x, first.x);
  vec3 sum[kResizeBlock][kResizeBlock];
  [[unroll]] for (uint y = 0u; y < kResizeBlock; ++y)
    [[unroll]] for (uint x = 0u; x < kResizeBlock; ++x) sum[y][x] = vec3(0.0);
  float rows[kResizeBlock][kFrom];
  [[unroll]] for (uint y = 0u; y < kResizeBlock; ++y) rows[y] = shares_of(float(at.y + int(y)), scale.y, first.y);
  [[unroll]] for (uint j = 0u; j < kFrom; ++j) {
    vec3 row[kResizeBlock];
    [[unroll]] for (uint x = 0u; x < kResizeBlock; ++x) row[x] = vec3(0.0);
    [[unroll]] for (uint i = 0u; i < kFrom; ++i) {
      ivec2 from = clamp(ivec2(first) + ivec2(i, j), ivec2(0), last);
      vec3 pixel = texelFetch(in_image, ivec3(from, at.z), 0).rgb;
      [[unroll]] for (uint x = 0u; x < kResizeBlock; ++x) row[x] += columns[x][i] * pixel;
    }
    [[unroll]] for (uint y = 0u; y < kResizeBlock; ++y)
      [[unroll]] for (uint x = 0u; x < kResizeBlock; ++x) sum[y][x] += rows[y][j] * row[x];
  }
  [[unroll]] for (uint y = 0u; y < kResizeBlock; ++y)
    [[unroll]] for (uint x = 0u; x < kResizeBlock; ++x) {
      ivec3 to = at + ivec3(x, y, 0);
      if (to.x < size.x && to.y < size.y) imageStore(out_image, to, vec4(sum[y][x], 1.0));
    }
}
