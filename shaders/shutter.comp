#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Motion blur and rolling shutter by the G-buffer's motion: a row's exposure begins when it is reset, and what moves
// passes over the pixel meanwhile. The frame's own instant is the middle of the middle row's exposure.
// For each time of its exposure a pixel asks which surfaces lie over it then: of each motion that passes here
// (shutter_reach.comp; tiles as McGuire et al. 2012 have them, "A reconstruction filter for plausible motion
// blur"), the place that it comes from, if that place moves so. Nearer surfaces cover farther ones. Where none was
// in the picture, what lay hidden at the frame's instant looks as the farthest of what is seen beside it.
#include "shared/exposure.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kExposureHdr) uniform texture2DArray hdr_image;
layout(set = 0, binding = kExposureMotion) uniform texture2DArray motion_image;
layout(set = 0, binding = kExposureDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kExposureTiles) uniform texture2DArray tile_image;
layout(set = 0, binding = kExposureOut, rgba16f) writeonly uniform image2DArray out_image;
layout(set = 0, binding = kExposureData, scalar) uniform Data { ShutterParams shutter; };

#include "shared/shutter.glsl"

const uint kMotions = 5u;  // the pixel's own, and four that pass

ivec3 inside(ivec2 at, int layer, ivec2 size) { return ivec3(clamp(at, ivec2(0), size - 1), layer); }

// What a surface gives a pixel: light times share, the share of the pixel that it covers, and its depth (larger is
// nearer).
struct Cover {
  vec3 light;
  float share, depth;
  vec2 way;
};

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec2 px = vec2(at.xy) + 0.5;
  float middle = row_time(px / vec2(size)), longest = abs(middle) + 0.5 * shutter.exposed;
  vec2 motions[kMotions];
  motions[0] = motion_at(at);
  uint motion_count = 1u;
  for (int i = 0; i < 4; ++i) {
    ivec2 tile = at.xy / int(kShutterTile);
    vec4 two = texelFetch(tile_image, ivec3(2 * tile.x + (i >> 1), tile.y, at.z), 0);
    vec2 motion = (i & 1) == 0 ? two.xy : two.zw;
    bool known = false;
    for (uint j = 0u; j < motion_count; ++j) known = known || same_way(motion * longest, motions[j] * longest);
    if (!known) motions[motion_count++] = motion;
  }
  vec3 sum = vec3(0.0);
  for (uint s = 0u; s < shutter.samples; ++s) {
    float time = middle + shutter.exposed * ((float(s) + 0.5) / float(shutter.samples) - 0.5);
    Cover covers[kMotions];
    uint cover_count = 0u;
    vec3 hidden = vec3(0.0);
    float hidden_depth = 3e38;
    for (uint k = 0u; k < motion_count; ++k) {
      vec2 way = way_of(motions[k], time), low, part, ways[4];
      ivec3 corners[4];
      // The place that comes here by its own motion: of the four pixels around it, one of the same surface tells.
      for (int i = 0; i < 4; ++i) {
        vec2 from = px - way - 0.5;
        low = floor(from);
        part = from - low;
        float nearest_px = 3e38;
        vec2 next = way;
        for (int c = 0; c < 4; ++c) {
          corners[c] = inside(ivec2(low) + ivec2(c & 1, c >> 1), at.z, size);
          ways[c] = way_of(motion_at(corners[c]), time);
          float off_px = distance(ways[c], way);
          if (off_px < nearest_px) {
            nearest_px = off_px;
            next = ways[c];
          }
        }
        // A surface's motion may change over it; a jump is another surface.
        if (i == 3 || nearest_px < 0.02 || nearest_px > allowed_px(length(way))) break;
        way = next;
      }
      Cover cover = Cover(vec3(0.0), 0.0, 0.0, way);
      vec4 beside = vec4(0.0);
      float beside_depth = 0.0;
      for (int c = 0; c < 4; ++c) {
        float weight = ((c & 1) == 0 ? 1.0 - part.x : part.x) * ((c >> 1) == 0 ? 1.0 - part.y : part.y);
        if (weight == 0.0) continue;
        vec3 light = texelFetch(hdr_image, corners[c], 0).rgb;
        float depth = texelFetch(depth_image, corners[c], 0).r;
        if (same_way(ways[c], way)) {
          cover.light += light * weight;
          cover.share += weight;
          cover.depth = max(cover.depth, depth);
        } else {
          beside += vec4(light, 1.0) * weight;
          beside_depth = max(beside_depth, depth);
        }
      }
      if (beside.a > 0.0 && beside_depth < hidden_depth) {
        hidden = beside.rgb / beside.a;
        hidden_depth = beside_depth;
      }
      bool known = cover.share == 0.0;
      for (uint j = 0u; j < cover_count; ++j) known = known || same_way(covers[j].way, way);
      if (!known) covers[cover_count++] = cover;
    }
    // The nearest first; each leaves the others what it does not cover.
    float left = 1.0;
    for (uint n = 0u; n < cover_count; ++n) {
      uint nearest = n;
      for (uint j = n + 1u; j < cover_count; ++j)
        if (covers[j].depth > covers[nearest].depth) nearest = j;
      Cover cover = covers[nearest];
      covers[nearest] = covers[n];
      sum += left * cover.light;
      left *= max(1.0 - cover.share, 0.0);
    }
    if (left > 1e-5) sum += left * hidden;
  }
  imageStore(out_image, at, vec4(min(sum / float(shutter.samples), vec3(60000.0)), 1.0));
}
