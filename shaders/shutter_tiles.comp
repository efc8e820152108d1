#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// The quickest and the slowest motion of each tile of the picture, for the shutter.
#include "shared/exposure.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kExposureMotion) uniform texture2DArray motion_image;
layout(set = 0, binding = kExposureOut, rgba32f) writeonly uniform image2DArray out_image;
layout(set = 0, binding = kExposureData, scalar) uniform Data { ShutterParams shutter; };

#include "shared/shutter.glsl"

void main() {
  ivec3 tile = ivec3(gl_GlobalInvocationID);
  ivec2 tiles = imageSize(out_image).xy;
  if (tile.x >= tiles.x || tile.y >= tiles.y) return;
  ivec2 first = tile.xy * int(kShutterTile);
  ivec2 last = min(first + int(kShutterTile), textureSize(motion_image, 0).xy);
  vec2 quickest = motion_at(ivec3(first, tile.z)), slowest = quickest;
  for (int y = first.y; y < last.y; ++y)
    for (int x = first.x; x < last.x; ++x) {
      vec2 motion = motion_at(ivec3(x, y, tile.z));
      float px2 = dot(motion, motion);
      if (px2 > dot(quickest, quickest)) quickest = motion;
      if (px2 < dot(slowest, slowest)) slowest = motion;
    }
  imageStore(out_image, tile, vec4(quickest, slowest));
}
