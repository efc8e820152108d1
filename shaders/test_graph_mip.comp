// Only for tests/graph: texel (x, y) of a mip = the sum of texels (2x, 2y) to (2x + 1, 2y + 1) of
// the mip above, those outside of it left out, times 3, plus 1.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform utexture2DArray above;
layout(binding = 1, r32ui) writeonly uniform uimage2DArray below;

void main() {
  const ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, imageSize(below)))) return;
  const ivec2 size = textureSize(above, 0).xy;
  uint sum = 0;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      const ivec2 from = 2 * at.xy + ivec2(x, y);
      if (all(lessThan(from, size))) sum += texelFetch(above, ivec3(from, at.z), 0).r;
    }
  imageStore(below, at, uvec4(sum * 3 + 1));
}
