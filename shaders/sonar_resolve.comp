#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// The gather's integers become a field, with the loss on the way to each range.
#include "shared/sonar_receiver.glsl"

layout(set = 0, binding = kReceiverIn, scalar) readonly buffer Sums { uvec2 sums[]; };
layout(set = 0, binding = kReceiverGains, scalar) readonly buffer Gains { vec2 gains[]; };
layout(set = 0, binding = kReceiverOut, rg32f) writeonly uniform image2DArray field;

void main() {
  c = pushed;
  uvec2 at = gl_GlobalInvocationID.xy;
  if (at.x >= c.columns || at.y >= c.rows) return;
  uvec2 sum = sums[at.y * c.columns + at.x];
  vec2 value = kCoherent != 0 ? vec2(int(sum.x), int(sum.y)) : vec2(float(sum.y) * 4294967296.0 + float(sum.x), 0.0);
  imageStore(field, ivec3(at, 0), vec4(value * c.scale * gains[at.y].x, 0.0, 0.0));
}
