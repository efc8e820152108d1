#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Sorts a picture's tiles, a shade workgroup each, into lists: by whether they show a solid (1) and whether a
// sight of theirs can meet the wavy surface (2). Shading has a pipeline for each: a CPU computes both sides of a
// branch for every pixel. Each list's head is what vkCmdDispatchIndirect reads.
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
  float nearest = 0.0, farthest = 1.0;
  for (int y = 0; y < int(kShadeGroup); ++y)
    for (int x = 0; x < int(kShadeGroup); ++x) {
      float depth = texelFetch(depth_image, ivec3(min(first + ivec2(x, y), last), 0), 0).r;
      nearest = max(nearest, depth);
      farthest = min(farthest, depth >= 1.0 ? 0.0 : depth);  // hidden pixels count as water (shade.comp)
    }
  uint list = nearest > 0.0 ? 1u : 0u;
  if (tile.y >= push.sea_first && tile.y < push.sea_end) {
    // How far up the tile's farthest solid can lie; nothing below the surface's lowest trough meets it.
    vec2 corner = vec2(first);
    float side = float(kShadeGroup);
    float up = push.ray_corner_y + corner.x * push.ray_dx_y + corner.y * push.ray_dy_y +
               max(push.ray_dx_y, 0.0) * side + max(push.ray_dy_y, 0.0) * side;
    if (farthest <= 0.0 || push.deep_m <= 0.0 || push.near_m * up >= 0.99 * push.deep_m * farthest) list += 2u;
  }
  uint slot = atomicAdd(tiles[kShadeTileHead * list], 1u);
  tiles[kShadeTileHead * kShadeTileLists + push.wide * push.high * list + slot] = tile.x | tile.y << 16;
  if (tile == uvec2(0u))
    for (uint i = 0u; i < kShadeTileLists; ++i) {
      tiles[kShadeTileHead * i + 1u] = 1u;
      tiles[kShadeTileHead * i + 2u] = 1u;
    }
}
