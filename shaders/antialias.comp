#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

// Smooths stairs on the display picture: where the luma of a 3x3 neighbourhood has a strong gradient, the
// pixel is blended along the edge (the idea of Lottes, "FXAA", 2009; own arrangement). The luma comes in
// the source's alpha.
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kAntialiasIn) uniform texture2DArray in_image;
layout(set = 0, binding = kAntialiasOut, rgba8) writeonly uniform image2DArray out_image;

// Pixels this near to the picture's edge stay as they are, so that no fetch leaves the picture.
const int kRim = 2;

vec4 pixel(ivec3 at) { return texelFetch(in_image, at, 0); }

// The picture at a place in pixels (centres at +0.5): linear between the two pixels across the edge's main
// axis, the nearest along it, where the picture hardly changes. By fetches: on a CPU a filtered sample
// costs more than four of them.
vec4 between(vec2 place, bool level, int layer) {
  vec2 p = place - 0.5;
  vec2 base = level ? vec2(floor(p.x + 0.5), floor(p.y)) : vec2(floor(p.x), floor(p.y + 0.5));
  ivec2 at = ivec2(base);
  vec4 a = pixel(ivec3(at, layer));
  vec4 b = pixel(ivec3(at + (level ? ivec2(0, 1) : ivec2(1, 0)), layer));
  return mix(a, b, level ? p.y - base.y : p.x - base.x);
}

// A block's pixels and those about it.
const int kAround = kAntialiasBlock + 2;
vec4 around[kAround][kAround];

// The pixel (x, y) of a block, at `at`, blended along its edge, if an edge runs there.
vec3 smoothed(ivec3 at, int x, int y, ivec2 size) {
  vec4 center = around[y + 1][x + 1];
  float m = center.a;
  float n = around[y][x + 1].a, s = around[y + 2][x + 1].a;
  float w = around[y + 1][x].a, e = around[y + 1][x + 2].a;
  float low = min(m, min(min(n, s), min(w, e))), high = max(m, max(max(n, s), max(w, e)));
  // Contrast that the eye takes for an edge: an eighth of the local light, at least 1/24.
  if (high - low < max(1.0 / 24.0, high / 8.0)) return center.rgb;
  float nw = around[y][x].a, ne = around[y][x + 2].a;
  float sw = around[y + 2][x].a, se = around[y + 2][x + 2].a;
  // Sobel gradient; the edge runs across it.
  vec2 gradient = vec2((ne + 2.0 * e + se) - (nw + 2.0 * w + sw), (sw + 2.0 * s + se) - (nw + 2.0 * n + ne));
  vec2 along = vec2(-gradient.y, gradient.x);
  along /= max(min(abs(along.x), abs(along.y)), 0.02 + 0.125 * (abs(along.x) + abs(along.y)));
  along = clamp(along, vec2(-8.0), vec2(8.0));
  bool level = abs(along.x) >= abs(along.y);
  vec2 place = vec2(at.xy) + 0.5, near = along * (1.0 / 6.0), far = along * 0.5;
  vec2 first = vec2(1.0), last = vec2(size) - 1.0;
  vec4 inner = 0.5 * (between(place + near, level, at.z) + between(place - near, level, at.z));
  vec4 ends = between(clamp(place + far, first, last), level, at.z) +
              between(clamp(place - far, first, last), level, at.z);
  vec4 outer = 0.5 * inner + 0.25 * ends;
  // A sample beyond the neighbourhood's range has left the edge: then the short blend.
  return outer.a < low || outer.a > high ? inner.rgb : outer.rgb;
}

// A block of pixels a lane: neighbours share what lies about them.
void main() {
  ivec3 first = ivec3(gl_GlobalInvocationID) * ivec3(kAntialiasBlock, kAntialiasBlock, 1);
  ivec2 size = imageSize(out_image).xy;
  if (first.x >= size.x || first.y >= size.y) return;
  [[unroll]] for (int y = 0; y < kAround; ++y)
    [[unroll]] for (int x = 0; x < kAround; ++x)
      around[y][x] = pixel(ivec3(clamp(first.xy + ivec2(x, y) - 1, ivec2(0), size - 1), first.z));
  [[unroll]] for (int y = 0; y < kAntialiasBlock; ++y)
    [[unroll]] for (int x = 0; x < kAntialiasBlock; ++x) {
      ivec3 at = first + ivec3(x, y, 0);
      bool rim = any(lessThan(at.xy, ivec2(kRim))) || any(greaterThanEqual(at.xy, size - kRim));
      if (at.x < size.x && at.y < size.y)
        imageStore(out_image, at, vec4(rim ? around[y + 1][x + 1].rgb : smoothed(at, x, y, size), 1.0));
    }
}
