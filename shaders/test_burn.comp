// For tests/gpu: keeps each invocation busy for a given number of steps.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) buffer Values { uint values[]; };
layout(push_constant, scalar) uniform Push { uint steps; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  uint x = values[i];
  for (uint k = 0; k < steps; ++k) x = x * 1664525u + 1013904223u;
  values[i] = x;
}
