#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

// The mean of the 4 x 4 pixels round one whose taps complete each other, but not across edges of the key (alpha).
#include "shared/lighting.h"
#include "shared/visibility.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kVisibilityBlurIn) uniform texture2DArray in_image;
layout(set = 0, binding = kVisibilityBlurOut, rgba8) writeonly uniform image2DArray out_image;

// A block of pixels a lane: neighbours share most of what they join.
void main() {
  const int kBlock = kVisibilityBlurBlock, kFrom = kVisibilityBlurBlock + 3;
  ivec3 first = ivec3(gl_GlobalInvocationID) * ivec3(kBlock, kBlock, 1);
  ivec2 size = imageSize(out_image).xy;
  if (first.x >= size.x || first.y >= size.y) return;
  vec4 from[kFrom][kFrom];
  [[unroll]] for (int y = 0; y < kFrom; ++y)
    [[unroll]] for (int x = 0; x < kFrom; ++x)
      from[y][x] = texelFetch(in_image, ivec3(clamp(first.xy + ivec2(x, y) - 2, ivec2(0), size - 1), first.z), 0);
  [[unroll]] for (int v = 0; v < kBlock; ++v)
    [[unroll]] for (int u = 0; u < kBlock; ++u) {
      vec4 own = from[v + 2][u + 2];
      vec4 sum = vec4(own.rgb, 1.0) * 1e-3;
      [[unroll]] for (int y = 0; y < 4; ++y)
        [[unroll]] for (int x = 0; x < 4; ++x) {
          vec4 seen = from[v + y][u + x];
          float weight = max(1.0 - abs(seen.a - own.a) * 100.0, 0.0);
          sum += vec4(seen.rgb, 1.0) * weight;
        }
      ivec3 at = first + ivec3(u, v, 0);
      if (at.x < size.x && at.y < size.y) imageStore(out_image, at, vec4(sum.rgb / sum.a, own.a));
    }
}
