#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// The receiver's output: power with noise, times the gain of its range.
#include "shared/sonar_receiver.glsl"
#include "shared/random.glsl"

layout(constant_id = kReceiverSpecNoise) const uint kNoise = 0;
layout(set = 0, binding = kReceiverIn, rg32f) readonly uniform image2DArray field;
layout(set = 0, binding = kReceiverGains, scalar) readonly buffer Gains { vec2 gains[]; };
layout(set = 0, binding = kReceiverOut, scalar) writeonly buffer Image { float image[]; };

void main() {
  c = pushed;
  uvec2 at = gl_GlobalInvocationID.xy;
  if (at.x >= c.out_columns || at.y >= c.rows) return;
  vec2 value = imageLoad(field, ivec3(at, 0)).rg;
  if (kCoherent == 0 && kNoise != 0) value.x = sqrt(max(value.x, 0.0));  // amplitude
  if (kNoise != 0) {
    uint cell = at.y * c.out_columns + at.x;
    value += c.noise * complex_normal(hash_of(uvec4(cell, c.ping, c.seed, 0x6e6f6973u)).xy, 0.0);
  }
  float power = kCoherent != 0 || kNoise != 0 ? dot(value, value) : value.x;
  image[at.y * c.out_columns + at.x] = max(power, 0.0) * gains[at.y].y;
}
