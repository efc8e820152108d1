#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Motion blur and rolling shutter by the G-buffer's motion: a row's exposure begins when it is reset, and what moves
// passes over the pixel meanwhile. The frame's own instant is the middle of the middle row's exposure.
#include "shared/exposure.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kExposureHdr) uniform texture2DArray hdr_image;
layout(set = 0, binding = kExposureOther) uniform texture2DArray motion_image;
layout(set = 0, binding = kExposureOut, rgba16f) writeonly uniform image2DArray out_image;
layout(set = 0, binding = kExposureData, scalar) uniform Data { ShutterParams shutter; };

ivec3 inside(vec2 px, int layer, ivec2 size) { return ivec3(clamp(ivec2(floor(px)), ivec2(0), size - 1), layer); }

// A point that will be behind the camera counts as still.
vec2 motion_at(ivec3 at) {
  vec2 motion = texelFetch(motion_image, at, 0).xy;
  return any(isnan(motion)) || any(isinf(motion)) ? vec2(0.0) : motion;
}

// The share of the sensor's rows above that of a point of the picture.
float row_share(vec2 share) {
  if (shutter.by_lens == 0u) return share.y;
  vec2 at = clamp(share, 0.0, 1.0) * float(kRowSteps), low = min(floor(at), vec2(float(kRowSteps - 1u))), part = at - low;
  uint i = uint(low.y) * (kRowSteps + 1u) + uint(low.x);
  return mix(mix(shutter.row[i], shutter.row[i + 1u], part.x),
             mix(shutter.row[i + kRowSteps + 1u], shutter.row[i + kRowSteps + 2u], part.x), part.y);
}

vec3 picture(vec2 px, int layer, ivec2 size) {
  vec2 at = px - 0.5, low = floor(at), part = at - low;
  vec3 corners[4];
  for (int i = 0; i < 4; ++i) corners[i] = texelFetch(hdr_image, inside(low + vec2(i & 1, i >> 1), layer, size), 0).rgb;
  return mix(mix(corners[0], corners[1], part.x), mix(corners[2], corners[3], part.x), part.y);
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec2 px = vec2(at.xy) + 0.5;
  // When the row is exposed, against the frame's instant; in times to the next frame.
  float row_time = shutter.readout * (row_share(px / vec2(size)) - 0.5);
  vec2 motion = motion_at(at);
  // Where that came from at the row's time: once more, since what moves there may move otherwise.
  for (int i = 0; i < 2; ++i) {
    vec2 back = motion * row_time;
    float far = length(back);
    if (far > shutter.farthest_px) back *= shutter.farthest_px / far;
    motion = motion_at(inside(px - back, at.z, size));
  }
  // The quickest of what is near passes over this pixel too.
  vec2 quickest = motion;
  for (int i = 0; i < 12; ++i) {
    float angle = float(i) * 1.57079633 + float(i / 4) * 0.52, out_px = i < 4 ? 4.0 : (i < 8 ? 12.0 : 36.0);
    vec2 seen = motion_at(inside(px + vec2(cos(angle), sin(angle)) * out_px, at.z, size));
    if (dot(seen, seen) > dot(quickest, quickest)) quickest = seen;
  }
  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < shutter.samples; ++i) {
    float share = (float(i) + 0.5) / float(shutter.samples) - 0.5;
    vec2 along = motion * (row_time + shutter.exposed * share);
    // Odd samples look along the quickest motion.
    bool other = (i & 1u) == 1u && dot(quickest, quickest) > 1.2 * dot(motion, motion) + 1.0;
    if (other) along = quickest * (row_time + shutter.exposed * share);
    float far = length(along);
    if (far > shutter.farthest_px) along *= shutter.farthest_px / far;
    float weight = 1.0;
    if (other) {
      // It counts if what is there moves far enough to have been here.
      vec2 there = motion_at(inside(px - along, at.z, size));
      weight = smoothstep(0.5, 0.9, dot(there, quickest) / max(dot(quickest, quickest), 1e-6));
    }
    sum += vec4(picture(px - along, at.z, size), 1.0) * weight;
  }
  imageStore(out_image, at, vec4(min(sum.rgb / max(sum.a, 1e-6), vec3(60000.0)), 1.0));
}
