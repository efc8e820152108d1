#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require

// One ray a texel of the surface: refracted by the waves' slope (Snell), it lands on each level beside where flat
// water would send it, and its energy is shared by four texels. The tile repeats, so nothing leaves it.
#include "shared/caustics.h"
#include "shared/even.glsl"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kCausticsParams, scalar) uniform Params { CausticsParams params; };
layout(set = 0, binding = kCausticsSums, scalar) buffer Sums { uint sums[]; };

// Waves first to first + kLanes - 1: a processor's lanes read one each. All lanes call these.
CausticWave wave_of_lane(uint first) { return params.waves[min(first + (by_lanes() ? lane() : 0u), kMaxCausticWaves - 1u)]; }
CausticWave wave_of(CausticWave own, uint first, uint k) {
  if (!by_lanes()) return params.waves[min(first + k, kMaxCausticWaves - 1u)];
  vec2 number = vec2(from_lane(own.wave_number.x, k), from_lane(own.wave_number.y, k));
  return CausticWave(number, from_lane(own.amplitude_m, k), from_lane(own.angle_rad, k));
}

// at: from 0 to n, which is 0 again.
void add(uint level, uint n, uvec2 at, uint energy) {
  atomicAdd(sums[(level * n + (at.y < n ? at.y : 0u)) * n + (at.x < n ? at.x : 0u)], energy);
}

void main() {
  // Read before any branch (shared/even.glsl).
  uint n = params.texels, count = params.count, first_level = params.first_level, end_level = params.end_level;
  float tile_m = params.tile_m, first_m = params.first_m, step = params.step;
  vec3 travel_air = params.travel_air;
  uvec2 at = gl_GlobalInvocationID.xy;
  float texel_m = tile_m / float(n);
  vec2 place = (vec2(at) + 0.5) * texel_m;
  vec2 slope = vec2(0.0);
  for (uint first = 0u; first < count; first += kLanes) {
    CausticWave own = wave_of_lane(first);
    [[unroll]] for (uint k = 0u; k < kLanes; ++k) {
      CausticWave w = wave_of(own, first, k);
      float amplitude_m = first + k < count ? w.amplitude_m : 0.0;
      slope -= amplitude_m * sin(dot(w.wave_number, place) + w.angle_rad) * w.wave_number;
    }
  }
  if (at.x >= n || at.y >= n) return;
  vec3 normal = normalize(vec3(-slope.x, 1.0, -slope.y));
  // A slope that turns away from the sun lies in the shadow of its own crest: no steeper than grazing.
  vec3 travel = travel_air;
  float facing = dot(travel, normal);
  if (facing > -0.02) travel = normalize(travel - (facing + 0.02) * normal);
  vec3 below = refract(travel, normal, 1.0 / kWaterIndex);
  vec3 flat_below = refract(travel_air, vec3(0.0, 1.0, 0.0), 1.0 / kWaterIndex);
  vec2 aside = below.xz / max(-below.y, 0.05) - flat_below.xz / max(-flat_below.y, 0.05);
  float depth_m = first_m;
  for (uint level = 0u; level < first_level; ++level) depth_m *= step;
  for (uint level = first_level; level < end_level; ++level) {
    // From the texel's corner; far enough into positive numbers that rounding is towards zero.
    vec2 lands = vec2(at) + aside * (depth_m / texel_m);
    vec2 whole = floor(lands);
    uvec2 part = uvec2((lands - whole) * float(kCausticPart) + 0.5);
    uvec2 first = uvec2(ivec2(mod(whole, vec2(n))));
    if (first.x >= n) first.x -= n;  // a quotient that was rounded up
    if (first.y >= n) first.y -= n;
    uvec2 rest = kCausticPart - part;
    add(level, n, first, rest.x * rest.y);
    add(level, n, first + uvec2(1, 0), part.x * rest.y);
    add(level, n, first + uvec2(0, 1), rest.x * part.y);
    add(level, n, first + uvec2(1, 1), part.x * part.y);
    depth_m *= step;
  }
}
