#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// One level of the forward scatter's pyramid from the one before: the mean light, and the distance that it
// came from, weighted by it.
#include "shared/forward_scatter.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;
layout(constant_id = kSpecScatterSide) const int kSide = 2;

layout(set = 0, binding = kScatterFrom, rgba16f) readonly uniform image2DArray from_image;
layout(set = 0, binding = kScatterTo, rgba16f) writeonly uniform image2DArray to_image;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(to_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  ivec2 last = imageSize(from_image).xy - 1;
  vec3 sum = vec3(0.0);
  float distances = 0.0, weights = 0.0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      vec4 light = imageLoad(from_image, ivec3(min(at.xy * kSide + ivec2(x, y), last), at.z));
      float weight = abs(light.r) + abs(light.g) + abs(light.b) + 1e-6;
      sum += light.rgb;
      distances += weight * light.a;
      weights += weight;
    }
  imageStore(to_image, at, vec4(sum / float(kSide * kSide), distances / weights));
}
