#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// The motions that pass over each tile while it is exposed: its own, and those of tiles that their motion carries
// over it. Of more than four that differ it keeps the quickest.
#include "shared/exposure.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

// Named as shutter.glsl asks: what each tile moves by.
layout(set = 0, binding = kExposureTiles) uniform texture2DArray motion_image;
layout(set = 0, binding = kExposureOut, rgba32f) writeonly uniform image2DArray out_image;
layout(set = 0, binding = kExposureData, scalar) uniform Data { ShutterParams shutter; };

#include "shared/shutter.glsl"

vec2 found[4];
uint count = 0u;
float longest;  // the time, either way

void keep(vec2 motion) {
  uint slowest = 0u;
  for (uint i = 0u; i < count; ++i) {
    if (same_way(motion * longest, found[i] * longest)) return;
    if (dot(found[i], found[i]) < dot(found[slowest], found[slowest])) slowest = i;
  }
  if (count < 4u)
    found[count++] = motion;
  else if (dot(motion, motion) > dot(found[slowest], found[slowest]))
    found[slowest] = motion;
}

// From the tile, how far the way of a motion passes by, over the times.
float passes_by(vec2 from, vec2 motion, vec2 times) {
  vec2 first = way_of(motion, times.x), along = way_of(motion, times.y) - first;
  vec2 to_first = from + first;
  float part = clamp(-dot(to_first, along) / max(dot(along, along), 1e-9), 0.0, 1.0);
  return length(to_first + part * along);
}

void main() {
  ivec3 tile = ivec3(gl_GlobalInvocationID);
  ivec2 tiles = textureSize(motion_image, 0).xy;
  if (tile.x >= tiles.x || tile.y >= tiles.y) return;
  vec2 times = vec2(1e9, -1e9);
  for (int i = 0; i < 4; ++i) {
    float time = row_time((vec2(tile.xy) + vec2(i & 1, i >> 1)) / shutter.tiles);
    times = vec2(min(times.x, time), max(times.y, time));
  }
  times += vec2(-0.5, 0.5) * shutter.exposed;
  longest = max(abs(times.x), abs(times.y));
  vec4 own = texelFetch(motion_image, tile, 0);
  keep(own.xy);
  keep(own.zw);
  int reach = int(ceil(shutter.farthest_px / float(kShutterTile))) + 1;
  ivec2 from = max(tile.xy - reach, ivec2(0)), until = min(tile.xy + reach, tiles - 1);
  for (int y = from.y; y <= until.y; ++y)
    for (int x = from.x; x <= until.x; ++x) {
      vec4 there = texelFetch(motion_image, ivec3(x, y, tile.z), 0);
      vec2 offset = (vec2(x, y) - vec2(tile.xy)) * float(kShutterTile);
      // Two tiles touch where their middles are a diagonal apart.
      if (passes_by(offset, there.xy, times) < 1.5 * float(kShutterTile)) keep(there.xy);
      if (passes_by(offset, there.zw, times) < 1.5 * float(kShutterTile)) keep(there.zw);
    }
  for (uint i = count; i < 4u; ++i) found[i] = found[0];
  imageStore(out_image, ivec3(2 * tile.x, tile.yz), vec4(found[0], found[1]));
  imageStore(out_image, ivec3(2 * tile.x + 1, tile.yz), vec4(found[2], found[3]));
}
