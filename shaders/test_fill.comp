// For tests/gpu: output[i] = factor * input[i] + add + bias, with factor a specialization constant,
// add pushed, bias in a uniform block.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kFactor = 1;
layout(scalar, set = 0, binding = 0) readonly buffer Input { uint input_values[]; };
layout(scalar, set = 0, binding = 1) writeonly buffer Output { uint output_values[]; };
layout(set = 0, binding = 2) uniform Bias { uint bias; };
layout(push_constant, scalar) uniform Push { uint count; uint add; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  output_values[i] = kFactor * input_values[i] + add + bias;
}
