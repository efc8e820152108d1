// For tests/gpu: the interpolated colour, after a given number of wasted steps.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 target;
layout(push_constant, scalar) uniform Push { float offset_x[2]; uint burn_steps; };

void main() {
  uint x = uint(gl_FragCoord.x);
  for (uint k = 0; k < burn_steps; ++k) x = x * 1664525u + 1013904223u;
  target = x == 0xffffffffu ? vec4(0.0) : color;
}
