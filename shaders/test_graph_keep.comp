// Only for tests/graph: next = last * 3 + add + x + 100 * y. A last frame that was lost, or mixed up
// with another one, changes the result.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform utexture2DArray last;
layout(binding = 1, r32ui) writeonly uniform uimage2DArray next;
layout(push_constant) uniform Push { uint add; } push;

void main() {
  const ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, imageSize(next)))) return;
  const uint kept = texelFetch(last, at, 0).r;
  imageStore(next, at, uvec4(kept * 3 + push.add + uint(at.x) + 100 * uint(at.y)));
}
