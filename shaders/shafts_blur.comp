#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// The mean of the 4 x 4 pixels whose samples complete each other, less across edges of distance.
#include "shared/lighting.h"
#include "shared/shafts.h"
#include "shared/shaft_texel.glsl"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kShaftBlurIn) uniform texture2DArray in_image;
layout(set = 0, binding = kShaftBlurOut, r32f) writeonly uniform image2DArray out_image;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec2 own = unpacked_shaft(texelFetch(in_image, at, 0).r);
  vec2 sum = vec2(own.x, 1.0) * 1e-3;
  for (int y = -2; y < 2; ++y)
    for (int x = -2; x < 2; ++x) {
      ivec2 other = clamp(at.xy + ivec2(x, y), ivec2(0), size - 1);
      vec2 seen = unpacked_shaft(texelFetch(in_image, ivec3(other, at.z), 0).r);
      float weight = max(1.0 - abs(seen.y - own.y) * 20.0, 0.0);
      sum += vec2(seen.x, 1.0) * weight;
    }
  imageStore(out_image, at, vec4(packed_shaft(sum.x / sum.y, own.y)));
}
