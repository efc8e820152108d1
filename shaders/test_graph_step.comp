// Only for tests/graph: target[i] = source[i] * factor + source[(i + shift) % count]. A value that
// was read too early or overwritten too soon changes the result.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;

layout(binding = 0, scalar) readonly buffer Source { uint source[]; };
layout(binding = 1, scalar) buffer Target { uint target[]; };
layout(push_constant, scalar) uniform Push {
  uint count;
  uint factor;
  uint shift;
} push;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  target[i] = source[i] * push.factor + source[(i + push.shift) % push.count];
}
