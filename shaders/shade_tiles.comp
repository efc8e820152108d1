#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Sorts a picture's tiles, a shade workgroup each, into lists by whether they show a solid and whether they see the
// sea's surface. Shading has a pipeline for each: a CPU computes both sides of a branch for every pixel. Each list's
// head is what vkCmdDispatchIndirect reads.
#include "shared/lighting.h"
#include "shared/waves.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(push_constant, scalar) uniform Push { ShadeTilesPush push; };
layout(set = 0, binding = kShadeTilesDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kShadeTilesOut, scalar) buffer Tiles { uint tiles[]; };

// Whether a sight may come to the surface before the water has hidden it or it ends, at a planar distance:
// sea_meets() of shared/sea_surface.glsl says no where this does.
bool may_meet_sea(vec3 ray, float planar_m) {
  float up = 1.001 * ray.y * inversesqrt(dot(ray, ray));
  return up >= 2e-3 && push.sea_off_m * push.sea_clearest <= kSeaFaded * up && push.sea_off_m <= 1.001 * ray.y * planar_m;
}

void main() {
  uvec2 tile = gl_GlobalInvocationID.xy;
  if (tile.x >= push.wide || tile.y >= push.high) return;
  ivec2 last = textureSize(depth_image, 0).xy - 1;
  ivec2 first = ivec2(tile * kShadeGroup);
  float nearest = 0.0;
  bool meets = !(push.sea_off_m > 0.0);
  for (int y = 0; y < int(kShadeGroup); ++y)
    for (int x = 0; x < int(kShadeGroup); ++x) {
      ivec2 at = min(first + ivec2(x, y), last);
      float depth = texelFetch(depth_image, ivec3(at, 0), 0).r;
      nearest = max(nearest, depth);
      // Depth 1 marks what is hidden from the wearer (hidden.vert): behind it counts as open water.
      vec3 ray = push.ray_corner + (float(at.x) + 0.5) * push.ray_dx + (float(at.y) + 0.5) * push.ray_dy;
      meets = meets || may_meet_sea(ray, depth > 0.0 && depth < 1.0 ? push.near_m / depth : 1e9);
    }
  uint list = (nearest > 0.0 ? kShadeTileSolid : 0u) + (meets ? kShadeTileSea : 0u);
  uint slot = atomicAdd(tiles[kShadeTileHead * list], 1u);
  tiles[kShadeTileHead * kShadeTileLists + push.wide * push.high * list + slot] = tile.x | tile.y << 16;
  if (tile == uvec2(0u))
    for (uint i = 0u; i < kShadeTileLists; ++i) {
      tiles[kShadeTileHead * i + 1u] = 1u;
      tiles[kShadeTileHead * i + 2u] = 1u;
    }
}
