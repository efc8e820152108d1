#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Puts the light that water scatters forwards on the shaded picture, linear between the finest level's texels. An
// invocation has the pixels of one of them, so that nine texels are read for all.
#include "shared/forward_scatter.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kScatterFrom, rgba16f) readonly uniform image2DArray coarser_image;
layout(set = 0, binding = kScatterTo, rgba16f) uniform image2DArray hdr_image;

const int kSide = 1 << kScatterFirstLevel;

void main() {
  ivec3 own = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(hdr_image).xy, last = imageSize(coarser_image).xy - 1;
  if (own.x > last.x || own.y > last.y) return;
  // Each row of three texels at the block's columns, the first half of which lies before the middle texel.
  vec3 rows[3][kSide];
  [[unroll]] for (int j = 0; j < 3; ++j) {
    vec3 texels[3];
    [[unroll]] for (int i = 0; i < 3; ++i)
      texels[i] = imageLoad(coarser_image, ivec3(clamp(own.xy + ivec2(i, j) - 1, ivec2(0), last), own.z)).rgb;
    [[unroll]] for (int x = 0; x < kSide; ++x) {
      float part = (float(x) + 0.5) / float(kSide) - 0.5;
      rows[j][x] = part < 0.0 ? mix(texels[0], texels[1], part + 1.0) : mix(texels[1], texels[2], part);
    }
  }
  [[unroll]] for (int y = 0; y < kSide; ++y) {
    float part = (float(y) + 0.5) / float(kSide) - 0.5;
    [[unroll]] for (int x = 0; x < kSide; ++x) {
      ivec3 at = ivec3(own.xy * kSide + ivec2(x, y), own.z);
      vec3 added = part < 0.0 ? mix(rows[0][x], rows[1][x], part + 1.0) : mix(rows[1][x], rows[2][x], part);
      vec4 picture = imageLoad(hdr_image, ivec3(min(at.xy, size - 1), at.z));
      // A dark thing takes light from what lies beside it. Of a loss of more than half, picture^2 / (4 loss) remains:
      // continuous in value and slope, never zero.
      vec3 taken = max(-added / max(picture.rgb, vec3(1e-20)), vec3(0.5));
      vec3 sum = max(picture.rgb + added, picture.rgb * 0.25 / taken);
      if (at.x < size.x && at.y < size.y) imageStore(hdr_image, at, vec4(min(sum, vec3(60000.0)), picture.a));
    }
  }
}
