#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Adds the light of one level of the forward scatter's pyramid, with that of coarser levels, to the picture: in
// place, from the coarsest to the finest.
#include "shared/forward_scatter.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kScatterFrom, rgba16f) readonly uniform image2DArray coarser_image;
layout(set = 0, binding = kScatterTo, rgba16f) uniform image2DArray level_image;
layout(push_constant, scalar) uniform Push { ScatterPush push; };

#include "shared/scatter_between.glsl"

// At an end of the range nothing above the finest octave is left, and all below the coarsest.
vec3 passed(vec3 optical_length, float cycles_rad, float at_end) {
  if (cycles_rad <= 0.0) return at_end < 0.5 ? exp(-optical_length) : vec3(1.0);
  return vec3(scatter_contrast(optical_length.r, cycles_rad, push.angle_rad),
              scatter_contrast(optical_length.g, cycles_rad, push.angle_rad),
              scatter_contrast(optical_length.b, cycles_rad, push.angle_rad));
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(level_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec4 light = imageLoad(level_image, at);
  vec3 optical_length = min(push.scattering * light.a, vec3(80.0));
  vec3 share = passed(optical_length, push.low_cycles_rad, 1.0) - passed(optical_length, push.high_cycles_rad, 0.0);
  vec3 out_light = light.rgb * max(share, vec3(0.0));
  if (push.low_cycles_rad > 0.0) out_light += light_between(at, 0.5);
  imageStore(level_image, at, vec4(out_light, 0.0));
}
