// Only for tests/graph: sums[layer] = the sum of an image layer's red texels, rounded, times factor.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform texture2DArray picture;
layout(binding = 1, scalar) buffer Sums { uint sums[]; };
layout(push_constant, scalar) uniform Push { uint factor; } push;

void main() {
  const ivec3 size = textureSize(picture, 0);
  const ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, size))) return;
  atomicAdd(sums[at.z], uint(texelFetch(picture, at, 0).r * 255.0 + 0.5) * push.factor);
}
