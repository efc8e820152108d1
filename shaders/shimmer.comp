#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

// Bends sight behind layers of water (shared/shimmer.h): each pixel shows the place where its turned
// sight ends. Pixels whose sights cross no layer stay as they are, bit by bit.
#include "shared/lighting.h"
#include "shared/raster.h"
#include "shared/shimmer.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kShimmerHdr) uniform texture2DArray hdr_image;
layout(set = 0, binding = kShimmerDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kShimmerOut, rgba16f) writeonly uniform image2DArray out_image;
layout(set = 0, binding = kShimmerViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kShimmerData, scalar) uniform Data { ShimmerParams data; };

layout(constant_id = kSpecShimmerLayers) const uint kLayers = 1;
layout(constant_id = kSpecShimmerWaves) const uint kWaves = kShimmerWaves;

const float kFarthest_m = 1e6;
// The longest waves, which come first, have nearly all of the lift.
const uint kLifting = 5u;
// No sight turns by more (the critical angle of fresh water over the sea is 0.1).
const float kMostTurn = 0.2;

vec4 texel(ivec2 at, int layer, ivec2 size) { return texelFetch(hdr_image, ivec3(clamp(at, ivec2(0), size - 1), layer), 0); }

float length_at(ivec3 at, float near_m, float stretch) {
  float depth = texelFetch(depth_image, at, 0).r;
  return depth > 0.0 ? near_m / depth * stretch : kFarthest_m;
}

void main() {
  ShimmerParams layers;
  [[unroll]] for (uint i = 0u; i < kLayers; ++i) {
    layers.layers[i].height_m = data.layers[i].height_m;
    layers.layers[i].sigma_m = data.layers[i].sigma_m;
    layers.layers[i].bend = data.layers[i].bend;
    [[unroll]] for (uint w = 0u; w < kWaves; ++w) layers.layers[i].waves[w] = data.layers[i].waves[w];
  }
  uint view = gl_WorkGroupID.z;
  vec3 eye = views[view].eye, corner = views[view].ray_corner, dx = views[view].ray_dx, dy = views[view].ray_dy;
  float near_m = views[view].near_m;
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec3 ray = corner + (float(at.x) + 0.5) * dx + (float(at.y) + 0.5) * dy;
  float stretch = length(ray);
  vec3 direction = ray / stretch;
  float length_m = length_at(at, near_m, stretch);
  vec3 turn = vec3(0.0);
  float crossing_m = 0.0;  // to the farthest layer that is crossed
  [[unroll]] for (uint i = 0u; i < kLayers; ++i) {
    ShimmerCrossing crossing = shimmer_crossing(eye.y - layers.layers[i].height_m, direction.y, length_m,
                                                layers.layers[i].sigma_m, layers.layers[i].bend);
    if (!(crossing.strength > 1e-3)) continue;
    // Long waves move the crossing by as much as short ones are long: first the lift, then the slopes there.
    vec2 place = (eye + direction * crossing.way_m).xz, slope = vec2(0.0);
    float lift_m = 0.0;
    [[unroll]] for (uint w = 0u; w < min(kWaves, kLifting); ++w)
      lift_m += shimmer_wave(layers.layers[i].waves[w], place, direction.xz, crossing.spread2).y;
    crossing.way_m = lifted_way(crossing, lift_m, length_m);
    place = (eye + direction * crossing.way_m).xz;
    [[unroll]] for (uint w = 0u; w < kWaves; ++w)
      slope += shimmer_wave(layers.layers[i].waves[w], place, direction.xz, crossing.spread2).xz;
    turn += shimmer_turn(crossing, layers.layers[i].bend, direction, slope, length_m);
    crossing_m = max(crossing_m, crossing.way_m);
  }
  float size_of = length(turn);
  if (!(size_of > 1e-7)) {
    imageStore(out_image, at, texelFetch(hdr_image, at, 0));
    return;
  }
  if (size_of > kMostTurn) turn *= kMostTurn / size_of;
  // Where the turned direction lies on the picture.
  vec3 ahead = normalize(cross(dx, dy));
  ahead *= dot(ahead, ray) < 0.0 ? -1.0 : 1.0;
  vec3 turned = direction + turn;
  vec3 off = turned / max(dot(turned, ahead), 1e-3) * dot(ray, ahead) - ray;
  vec2 shift = vec2(dot(off, dx) / dot(dx, dx), dot(off, dy) / dot(dy, dy));
  vec2 from = vec2(at.xy) + shift;
  ivec2 nearest = clamp(ivec2(round(from)), ivec2(0), size - 1);
  // Things before the layers hide nothing that these bend, and nearer things move less.
  float there_m = length_at(ivec3(nearest, at.z), near_m, stretch);
  shift *= clamp((1.0 - crossing_m / there_m) / max(1.0 - crossing_m / length_m, 1e-3), 0.0, 1.0);
  // Places beyond the picture's edge are mirrored at it: clamped they would show as streaks.
  vec2 last = vec2(size - 1);
  from = clamp(last - abs(last - abs(vec2(at.xy) + shift)), vec2(0.0), last);
  vec2 low = floor(from), part = from - low;
  ivec2 i = ivec2(low);
  imageStore(out_image, at,
             mix(mix(texel(i, at.z, size), texel(i + ivec2(1, 0), at.z, size), part.x),
                 mix(texel(i + ivec2(0, 1), at.z, size), texel(i + ivec2(1, 1), at.z, size), part.x), part.y));
}
