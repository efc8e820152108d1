#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

// The share of the sun's beam (red), of the light round it (green) and of the surroundings (blue) that
// reaches a surface; alpha: its key (shared/visibility.glsl). Taps of 16 neighbours differ, and the blur that follows joins them.
#include "shared/lighting.h"
#include "shared/octahedral.h"
#include "shared/visibility.glsl"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kVisibilityViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kVisibilityParams, scalar) uniform Params { VisibilityParams param_data; };

// Copies, made before any branch: a processor's driver reads them faster there (shared/even.glsl).
VisibilityParams params;
View view;
layout(set = 0, binding = kVisibilityDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kVisibilityNormal) uniform texture2DArray normal_image;
layout(set = 0, binding = kVisibilityCascades) uniform texture2DArray cascade_image;
layout(set = 0, binding = kVisibilityOut, rgba8) writeonly uniform image2DArray out_image;

layout(constant_id = kSpecCascades) const uint kCascades = 0;
layout(constant_id = kSpecOcclusionTaps) const uint kOcclusionTaps = 0;
layout(constant_id = kSpecVisibilityScale) const uint kScale = 2;

layout(constant_id = kSpecShadowTaps) const uint kTaps = 9;
// Radii of the taps' rings, of the narrowest and the factor to the next. However many, they reach as far.
const float kRing_m = 0.02, kRingReach = 88.0;
// Cosine and sine of the golden angle, by which each tap is turned on against the one before.
const vec2 kGolden = vec2(-0.73736888, 0.67549029);
vec2 turned_on(vec2 v) { return vec2(kGolden.x * v.x - kGolden.y * v.y, kGolden.y * v.x + kGolden.x * v.y); }

// Shares of the sun's core (x) and of the light round it (y) that what stands between takes away. A tap says of
// a ring at its height over the surface how far light from within the ring would have to be turned; the
// light's spread is s^2 / (r^2 + s^2)^2 over the tangent (heavy tails, as scattering has).
vec2 sun_hidden(vec3 position, vec3 normal, float depth_m, float turn) {
  uint cascade = kCascades;
  vec2 where = vec2(0.0);
  float receiver_m = 0.0;
  float half_m = 1.0, near_m = 1.0;
  vec3 across = vec3(0.0), along = vec3(0.0);
  [[unroll]] for (uint c = 0u; c < kCascades; ++c) {
    vec4 clip = params.cascades[c].clip_from_origin * vec4(position, 1.0);
    vec2 at = clip.xy / clip.w;
    float own_half_m = params.cascades[c].half_m, margin = 1.0 - 1.3 / own_half_m;
    if (cascade == kCascades && max(abs(at.x), abs(at.y)) < margin) {
      cascade = c;
      where = at;
      receiver_m = clip.w;
      half_m = own_half_m;
      near_m = params.cascades[c].near_m;
      across = params.cascades[c].across;
      along = params.cascades[c].along;
    }
  }
  if (cascade == kCascades) return vec2(0.0);
  int size = textureSize(cascade_image, 0).x;
  float texel_m = 2.0 * half_m / float(size);
  // The sign stays: the plane of a face that is turned away is the same.
  float toward = dot(normal, params.to_sun);
  float facing = toward < 0.0 ? min(toward, -0.03) : max(toward, 0.03);
  // Metres towards the sun that the surface rises a metre across and along.
  vec2 slope = -vec2(dot(normal, across), dot(normal, along)) / facing;
  float bias_m = 0.004 + texel_m * (0.5 + 0.7 * (abs(slope.x) + abs(slope.y)));
  float way_m = depth_m / params.sun_cosine;
  float core = sqrt(params.spread * params.spread + params.scattering_m * way_m * kCoreVariance);
  vec2 spread = vec2(core, kSkySpread);
  vec2 hidden = vec2(0.0);
  const float kOctaves = log2(kRingReach) / float(max(kTaps, 2u) - 1u);
  const float kRingFactor = exp2(kOctaves), kEdge = exp2(0.5 * kOctaves);
  float ring_m = kRing_m * exp2(kOctaves * (turn - 0.5));
  vec2 last = vec2(ring_m * exp2(kOctaves * (float(kTaps) - 1.0)) * kEdge);
  last *= last;
  float inner_m = 0.0;
  vec2 way = vec2(cos(turn * 6.2831853), sin(turn * 6.2831853));
  for (uint i = 0u; i < kTaps; ++i) {
    vec2 offset_m = ring_m * way;
    way = turned_on(way);
    ivec2 at = ivec2((where * 0.5 + 0.5 + offset_m * vec2(0.5, -0.5) / half_m) * float(size));
    at = clamp(at, ivec2(0), ivec2(size - 1));
    float seen_m = near_m / max(texelFetch(cascade_image, ivec3(at, cascade), 0).r, 1e-9);
    float height_m = receiver_m - dot(slope, offset_m) - seen_m;
    float outer_m = ring_m * kEdge;
    if (height_m > bias_m) {
      vec2 s = spread * height_m;
      s *= s;
      float inner2 = inner_m * inner_m, outer2 = outer_m * outer_m;
      hidden += (outer2 / (outer2 + s) - inner2 / (inner2 + s)) * (last + s) / last;
    }
    inner_m = outer_m;
    ring_m *= kRingFactor;
  }
  return clamp(hidden, vec2(0.0), vec2(1.0));
}

// Share of the surroundings that near surfaces hide: what rises over the surface's plane within reach.
float occluded(uint layer, ivec2 full, ivec2 size, vec3 position, vec3 normal, float planar_m, float turn) {
  float pixels = params.occlusion_m / (planar_m * length(view.ray_dx));
  pixels = min(pixels, 0.25 * float(size.y));
  if (pixels < 2.0) return 0.0;
  float sum = 0.0;
  vec2 way = vec2(cos(turn * 6.2831853), sin(turn * 6.2831853));
  for (uint i = 0u; i < kOcclusionTaps; ++i) {
    float share = (float(i) + 0.2 + 0.8 * turn) / float(kOcclusionTaps);
    vec2 offset = way * max(pixels * share * share, 1.5 + float(i) * 0.5);
    way = turned_on(way);
    ivec2 at = full + ivec2(round(offset));
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
    float depth = texelFetch(depth_image, ivec3(at, layer), 0).r;
    float z = view.near_m / max(depth, 1e-9);
    vec3 ray = view.ray_corner + (float(at.x) + 0.5) * view.ray_dx + (float(at.y) + 0.5) * view.ray_dy;
    vec3 v = view.eye + ray * z - position;
    float d2 = dot(v, v);
    float rise = dot(normal, v) * inversesqrt(max(d2, 1e-12));
    sum += max(rise - 0.1, 0.0) * max(1.0 - d2 / (params.occlusion_m * params.occlusion_m), 0.0);
  }
  return clamp(2.2 * sum / float(kOcclusionTaps), 0.0, 1.0);
}

void take_params() {
  params.to_sun = param_data.to_sun;
  params.origin_depth_m = param_data.origin_depth_m;
  params.spread = param_data.spread;
  params.scattering_m = param_data.scattering_m;
  params.sun_cosine = param_data.sun_cosine;
  params.occlusion_m = param_data.occlusion_m;
  [[unroll]] for (uint c = 0u; c < kCascades; ++c) params.cascades[c] = param_data.cascades[c];
}

void main() {
  uint layer = gl_WorkGroupID.z;
  view.eye = views[layer].eye;
  view.near_m = views[layer].near_m;
  view.ray_corner = views[layer].ray_corner;
  view.ray_dx = views[layer].ray_dx;
  view.ray_dy = views[layer].ray_dy;
  take_params();
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 out_size = imageSize(out_image).xy;
  if (at.x >= out_size.x || at.y >= out_size.y) return;
  ivec2 size = textureSize(depth_image, 0).xy;
  ivec2 full = min(at.xy * int(kScale), size - 1);
  float depth = texelFetch(depth_image, ivec3(full, layer), 0).r;
  if (depth <= 0.0) {
    imageStore(out_image, at, vec4(1.0));
    return;
  }
  float planar_m = view.near_m / depth;
  vec3 ray = view.ray_corner + (float(full.x) + 0.5) * view.ray_dx + (float(full.y) + 0.5) * view.ray_dy;
  vec3 position = view.eye + ray * planar_m;
  vec3 normal = octahedral_decode(texelFetch(normal_image, ivec3(full, layer), 0).rg);
  // Bayer's order of the 16 places of a block.
  uvec2 b = uvec2(at.xy) & 3u;
  uint x = b.x ^ b.y;
  uint order = ((x & 1u) << 3) | ((b.y & 1u) << 2) | (x & 2u) | (b.y >> 1);
  float turn = (float(order) + 0.5) / 16.0;
  vec3 seen = vec3(1.0);
  if (kCascades > 0u) seen.xy -= sun_hidden(position, normal, max(params.origin_depth_m - position.y, 0.0), turn);
  if (kOcclusionTaps > 0u) seen.z -= occluded(layer, full, size, position, normal, planar_m, turn);
  imageStore(out_image, at, vec4(seen, visibility_key(planar_m, normal, params.to_sun)));
}
