#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Depth of field: a pixel gathers what spreads over it. A sample counts where its own spot reaches this pixel, by
// its light over the spot's area. A nearer surface out of focus covers what lies behind it by the share of its spots
// that reach here; what lies behind a sharper surface does not spread over that.
#include "shared/exposure.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kExposureHdr) uniform texture2DArray hdr_image;
layout(set = 0, binding = kExposureDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kExposureOut, rgba16f) writeonly uniform image2DArray out_image;
layout(set = 0, binding = kExposureData, scalar) uniform Data { FocusParams focus; };

float distance_at(ivec3 at) {
  float depth = texelFetch(depth_image, at, 0).r;
  return depth > 0.0 ? focus.near_m / depth : 1e9;
}

// Distances that differ by less, as a factor, are one surface's.
const float kSameSurface = 1.02;

// In the search for the widest spot: the spot of a place as far as it can spread here. From behind a surface
// nothing spreads farther than that surface's own spot.
float spot_here(ivec3 other, float own_m, float own_px) {
  float other_m = distance_at(other);
  float spot_px = max(spot_radius_px(focus, other_m), 0.5);
  return other_m > own_m * kSameSurface ? min(spot_px, own_px) : spot_px;
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  float own_m = distance_at(at);
  float own_px = max(spot_radius_px(focus, own_m), 0.5);
  // Each pixel turns its samples otherwise (Jimenez 2014, interleaved gradient noise).
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(vec2(at.xy), vec2(0.06711056, 0.00583715))));
  // How far off anything spreads to here from.
  float far_px = own_px;
  // Rings of six: a surface that spreads to here has one of them on it, unless only its spots' rims reach.
  for (float r = focus.widest_px; r > 1.0; r *= 0.54)
    for (uint i = 0u; i < 6u; ++i) {
      float angle = turn + r + 1.04719755 * float(i);
      ivec2 offset = ivec2(round(r * vec2(cos(angle), sin(angle))));
      float spot_px = spot_here(ivec3(clamp(at.xy + offset, ivec2(0), size - 1), at.z), own_m, own_px);
      if (spot_px > 0.5 * r) far_px = max(far_px, spot_px);
    }
  // Nearer surfaces spread over this pixel and cover a share of it. The pixel's own surface covers a share of the
  // rest, and surfaces behind it show through; the samples within its own spot find both shares.
  vec4 nearer = vec4(0.0), behind = vec4(0.0);
  // A pixel is 1 / pi of the disk of radius 1.
  vec4 own = vec4(texelFetch(hdr_image, at, 0).rgb, 1.0) * (0.3183 / (own_px * own_px));
  // A spiral of even density out to there.
  float each_px2 = far_px * far_px / float(focus.samples);
  for (uint i = 0u; i < focus.samples; ++i) {
    float r = far_px * sqrt((float(i) + 0.5) / float(focus.samples)), angle = turn + 2.39996323 * float(i);
    ivec2 offset = ivec2(round(r * vec2(cos(angle), sin(angle))));
    if (offset == ivec2(0)) continue;
    ivec3 other = ivec3(clamp(at.xy + offset, ivec2(0), size - 1), at.z);
    float other_m = distance_at(other);
    bool is_behind = other_m > own_m * kSameSurface;
    // All that lies behind within the own spot shows through it.
    float spot_px = is_behind ? own_px : max(spot_radius_px(focus, other_m), 0.5);
    float reaches = clamp(spot_px - r + 0.5, 0.0, 1.0);
    vec4 spread = vec4(texelFetch(hdr_image, other, 0).rgb, 1.0) * (reaches * each_px2 / (spot_px * spot_px));
    if (is_behind)
      behind += spread;
    else if (own_m > other_m * kSameSurface)
      nearer += spread;
    else
      own += spread;
  }
  vec3 rest = (own.rgb + behind.rgb) / (own.a + behind.a);
  vec3 light = nearer.rgb / max(nearer.a, 1.0) + rest * max(1.0 - nearer.a, 0.0);
  imageStore(out_image, at, vec4(min(light, vec3(60000.0)), 1.0));
}
