#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// A display picture of another size: between the four nearest pixels. By fetches: on a CPU a filtered sample costs more than four of them.
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kResizeIn) uniform texture2DArray in_image;
layout(set = 0, binding = kResizeOut, rgba8) writeonly uniform image2DArray out_image;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  ivec2 last = textureSize(in_image, 0).xy - 1;
  vec2 place = (vec2(at.xy) + 0.5) * (vec2(last + 1) / vec2(size)) - 0.5;
  vec2 corner = floor(place);
  // Steeper than linear between pixels: edges keep their contrast, flat gradients their slope.
  vec2 part = place - corner;
  part = mix(part, part * part * (3.0 - 2.0 * part), 0.5);
  ivec2 low = clamp(ivec2(corner), ivec2(0), last), high = clamp(ivec2(corner) + 1, ivec2(0), last);
  vec3 a = texelFetch(in_image, ivec3(low, at.z), 0).rgb, b = texelFetch(in_image, ivec3(high.x, low.y, at.z), 0).rgb;
  vec3 c = texelFetch(in_image, ivec3(low.x, high.y, at.z), 0).rgb, d = texelFetch(in_image, ivec3(high, at.z), 0).rgb;
  imageStore(out_image, at, vec4(mix(mix(a, b, part.x), mix(c, d, part.x), part.y), 1.0));
}
