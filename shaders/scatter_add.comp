#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Puts the light that water scatters forwards on the shaded picture.
#include "shared/forward_scatter.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kScatterFrom, rgba16f) readonly uniform image2DArray coarser_image;
layout(set = 0, binding = kScatterTo, rgba16f) uniform image2DArray hdr_image;

#include "shared/scatter_between.glsl"

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(hdr_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec4 picture = imageLoad(hdr_image, at);
  vec3 added = light_between(at, 1.0 / float(1u << kScatterFirstLevel));
  imageStore(hdr_image, at, vec4(clamp(picture.rgb + added, vec3(0.0), vec3(60000.0)), picture.a));
}
