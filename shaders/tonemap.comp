#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Exposed scene radiance to a display picture: the filmic curve fitted by Stephen Hill to the ACES
// reference and output transforms (in ACES's wider primaries, so that a saturated sea keeps its shades),
// then the gamut of sRGB by hue and lightness (shared/gamut.h) and sRGB encoding.
#include "shared/gamut.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kTonemapHdr) uniform texture2DArray hdr_image;
layout(set = 0, binding = kTonemapOut, rgba8) writeonly uniform image2DArray out_image;

layout(constant_id = kSpecLumaInAlpha) const bool kLumaInAlpha = false;

// Columns of the matrices into and out of the fit's working space.
const mat3 kFromSrgb = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
const mat3 kToSrgb = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);

vec3 filmic(vec3 x) {
  // The fit leaves mid grey darker than the exposure asks for; 1.8 puts a white surface in scene light
  // at a display value of about 0.8.
  vec3 v = kFromSrgb * (x * 1.8);
  v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  return kToSrgb * v;
}

// IEC 61966-2-1. Its power of 1/2.4 by square roots, which every device has and which cost a CPU a fifth
// (own minimax fit on [0.0031308, 1], error below 4.5e-5: a ninetieth of a grey level of 8 bits).
vec3 srgb(vec3 x) {
  vec3 root = sqrt(max(x, vec3(0.003))), fourth = sqrt(root), eighth = sqrt(fourth);
  vec3 curve = 0.64236636 * root + 0.71210962 * fourth - 0.33686959 * eighth - 0.01756334 * x;
  return mix(12.92 * x, curve, greaterThan(x, vec3(0.0031308)));
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  // No more than a half float can represent, since the curve divides squares; what is not a number becomes 0.
  vec3 x = texelFetch(hdr_image, at, 0).rgb;
  x = mix(vec3(0.0), min(x, vec3(65504.0)), greaterThan(x, vec3(0.0)));
  vec3 c = srgb(map_into_gamut(filmic(x)));
  imageStore(out_image, at, vec4(c, kLumaInAlpha ? dot(c, vec3(0.299, 0.587, 0.114)) : 1.0));
}
