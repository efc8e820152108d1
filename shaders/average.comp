#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

// Light that a pixel gets, as the mean of a square of finer pixels.
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kAverageIn) uniform texture2DArray in_image;
layout(set = 0, binding = kAverageOut, rgba16f) writeonly uniform image2DArray out_image;

layout(constant_id = kSpecAverageSide) const int kSide = 2;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec3 sum = vec3(0.0);
  [[unroll]] for (int y = 0; y < kSide; ++y)
    [[unroll]] for (int x = 0; x < kSide; ++x)
      sum += texelFetch(in_image, ivec3(at.xy * kSide + ivec2(x, y), at.z), 0).rgb;
  imageStore(out_image, at, vec4(sum / float(kSide * kSide), 1.0));
}
