#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Exposed scene radiance to a display picture: filmic curve (fit of the ACES reference transform by
// Narkowicz 2015), sRGB encoding (IEC 61966-2-1).
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kTonemapHdr) uniform texture2DArray hdr_image;
layout(set = 0, binding = kTonemapOut, rgba8) writeonly uniform image2DArray out_image;

vec3 filmic(vec3 x) { return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0); }

vec3 srgb(vec3 x) {
  return mix(12.92 * x, 1.055 * pow(max(x, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055,
             greaterThan(x, vec3(0.0031308)));
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec3 x = max(texelFetch(hdr_image, at, 0).rgb, vec3(0.0));
  imageStore(out_image, at, vec4(srgb(filmic(x)), 1.0));
}
