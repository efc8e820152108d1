#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Smooths stairs on the display picture: where the luma of a 3x3 neighbourhood has a strong gradient, the
// pixel is blended along the edge (the idea of Lottes, "FXAA", 2009; own arrangement). Flat pixels, most
// of a sea, leave after five reads.
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kAntialiasIn) uniform texture2DArray in_image;
layout(set = 0, binding = kAntialiasOut, rgba8) writeonly uniform image2DArray out_image;

vec3 pixel(ivec3 at, ivec2 size) { return texelFetch(in_image, ivec3(clamp(at.xy, ivec2(0), size - 1), at.z), 0).rgb; }

float luma(vec3 c) { return dot(c, vec3(0.299, 0.587, 0.114)); }

// Bilinear sample at a place in pixels (centres at +0.5).
vec3 between(vec2 place, int layer, ivec2 size) {
  vec2 p = place - 0.5;
  ivec2 base = ivec2(floor(p));
  vec2 f = p - vec2(base);
  vec3 a = mix(pixel(ivec3(base, layer), size), pixel(ivec3(base + ivec2(1, 0), layer), size), f.x);
  vec3 b = mix(pixel(ivec3(base + ivec2(0, 1), layer), size), pixel(ivec3(base + ivec2(1, 1), layer), size), f.x);
  return mix(a, b, f.y);
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec3 center = pixel(at, size);
  float m = luma(center);
  float n = luma(pixel(at + ivec3(0, -1, 0), size)), s = luma(pixel(at + ivec3(0, 1, 0), size));
  float w = luma(pixel(at + ivec3(-1, 0, 0), size)), e = luma(pixel(at + ivec3(1, 0, 0), size));
  float low = min(m, min(min(n, s), min(w, e))), high = max(m, max(max(n, s), max(w, e)));
  // Contrast that the eye takes for an edge: an eighth of the local light, at least 1/24.
  if (high - low < max(1.0 / 24.0, high / 8.0)) {
    imageStore(out_image, at, vec4(center, 1.0));
    return;
  }
  float nw = luma(pixel(at + ivec3(-1, -1, 0), size)), ne = luma(pixel(at + ivec3(1, -1, 0), size));
  float sw = luma(pixel(at + ivec3(-1, 1, 0), size)), se = luma(pixel(at + ivec3(1, 1, 0), size));
  // Sobel gradient; the edge runs across it.
  vec2 gradient = vec2((ne + 2.0 * e + se) - (nw + 2.0 * w + sw), (sw + 2.0 * s + se) - (nw + 2.0 * n + ne));
  vec2 along = vec2(-gradient.y, gradient.x);
  along /= max(min(abs(along.x), abs(along.y)), 0.02 + 0.125 * (abs(along.x) + abs(along.y)));
  along = clamp(along, vec2(-8.0), vec2(8.0));
  vec2 place = vec2(at.xy) + 0.5;
  vec3 inner = 0.5 * (between(place + along * (1.0 / 6.0), at.z, size) + between(place - along * (1.0 / 6.0), at.z, size));
  vec3 outer = 0.5 * inner + 0.25 * (between(place + along * 0.5, at.z, size) + between(place - along * 0.5, at.z, size));
  // A sample beyond the neighbourhood's range has left the edge: then the short blend.
  float reach = luma(outer);
  imageStore(out_image, at, vec4(reach < low || reach > high ? inner : outer, 1.0));
}
