#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Sorts a picture's tiles, a shade workgroup each, into lists: those that show water alone and those that
// show a solid. Shading has a pipeline for each: a CPU
// computes both sides of a branch for every pixel. Each list's head is what vkCmdDispatchIndirect reads.
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(push_constant, scalar) uniform Push { ShadeTilesPush push; };
layout(set = 0, binding = kShadeTilesDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kShadeTilesOut, scalar) buffer Tiles { uint tiles[]; };

void main() {
  uvec2 tile = gl_GlobalInvocationID.xy;
  if (tile.x >= push.wide || tile.y >= push.high) return;
  ivec2 last = textureSize(depth_image, 0).xy - 1;
  ivec2 first = ivec2(tile * kShadeGroup);
  float nearest = 0.0;
  for (int y = 0; y < int(kShadeGroup); ++y)
    for (int x = 0; x < int(kShadeGroup); ++x)
      nearest = max(nearest, texelFetch(depth_image, ivec3(min(first + ivec2(x, y), last), 0), 0).r);
  uint list = nearest > 0.0 ? 1u : 0u;
  uint slot = atomicAdd(tiles[kShadeTileHead * list], 1u);
  tiles[kShadeTileHead * kShadeTileLists + push.wide * push.high * list + slot] = tile.x | tile.y << 16;
  if (tile == uvec2(0u))
    for (uint i = 0u; i < kShadeTileLists; ++i) {
      tiles[kShadeTileHead * i + 1u] = 1u;
      tiles[kShadeTileHead * i + 2u] = 1u;
    }
}
