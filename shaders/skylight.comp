#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

// The share of the light from above that still things let through, of a grid: red along a sight, by samples that
// each stand for an equal share of the light that the water adds; green at the surface at its end. Samples of 16
// neighbours differ, in an order that no frame changes; the blur that follows joins them.
#include "shared/lighting.h"
#include "shared/octahedral.h"
#include "shared/skylight.h"
#include "shared/visibility.glsl"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kSkylightViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kSkylightLighting, scalar) uniform Light { Lighting light_data; };
layout(set = 0, binding = kSkylightParams, scalar) uniform Data { SkylightParams params; };
layout(set = 0, binding = kSkylightDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kSkylightNormal) uniform texture2DArray normal_image;
layout(set = 0, binding = kSkylightGrid, scalar) readonly buffer Grid { float open[]; };
layout(set = 0, binding = kSkylightOut, rgba8) writeonly uniform image2DArray out_image;

layout(constant_id = kSpecSkylightTerms) const uint kTerms = ~0u;
layout(constant_id = kSpecSkylightSamples) const uint kSamples = 1;
bool light_has(uint term) { return (kTerms & term) != 0u; }
uint lamp_count() { return 0u; }
uint glow_samples() { return 1u; }

#include "shared/even_light.glsl"
#include "shared/water.glsl"

// Between the eight nearest cells; 1 outside.
float open_at(vec3 place) {
  vec3 p = (place - params.low) / params.cell_m - 0.5;
  vec3 base = floor(p), part = p - base;
  ivec3 cells = ivec3(params.nx, params.ny, params.nz);
  if (any(lessThan(base, vec3(-1.0))) || any(greaterThanEqual(base, vec3(cells)))) return 1.0;
  float sum = 0.0;
  [[unroll]] for (int i = 0; i < 8; ++i) {
    ivec3 corner = ivec3(i & 1, (i >> 1) & 1, i >> 2);
    ivec3 c = ivec3(base) + corner;
    bool inside = all(greaterThanEqual(c, ivec3(0))) && all(lessThan(c, cells));
    vec3 w = mix(1.0 - part, part, vec3(corner));
    c = clamp(c, ivec3(0), cells - 1);
    sum += w.x * w.y * w.z * (inside ? open[(c.y * cells.z + c.z) * cells.x + c.x] : 1.0);
  }
  return sum;
}

void main() {
  uint layer = gl_WorkGroupID.z;
  vec3 eye = views[layer].eye, ray_corner = views[layer].ray_corner, ray_dx = views[layer].ray_dx, ray_dy = views[layer].ray_dy;
  float near_m = views[layer].near_m;
  take_light();
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 out_size = imageSize(out_image).xy;
  if (at.x >= out_size.x || at.y >= out_size.y) return;
  ivec2 size = textureSize(depth_image, 0).xy;
  ivec2 full = min(at.xy * int(kSkylightStep), size - 1);
  float depth = texelFetch(depth_image, ivec3(full, layer), 0).r;
  float planar_m = depth > 0.0 ? near_m / depth : kForever_m;
  vec3 ray = ray_corner + (float(full.x) + 0.5) * ray_dx + (float(full.y) + 0.5) * ray_dy;
  float stretch = length(ray);
  vec3 direction = ray / stretch;
  // Half of a plane's sky lies behind it, and its own cells are dark: asked a cell and a half before the surface,
  // over what an open plane sees there.
  float there = 1.0;
  if (depth > 0.0) {
    vec3 normal = octahedral_decode(texelFetch(normal_image, ivec3(full, layer), 0).rg);
    float plane = max(0.5 + 0.5 * normal.y, 0.15);
    there = min(open_at(eye + ray * planar_m + normal * (1.5 * params.cell_m)) / plane, 1.0);
  }
  float along = 1.0;
  vec2 part_m = water_part(light.origin_depth_m - eye.y, direction, depth > 0.0 ? planar_m * stretch : kForever_m);
  // Where the sight is in the box.
  vec3 box = vec3(params.nx, params.ny, params.nz) * params.cell_m;
  vec3 slope = 1.0 / mix(direction, vec3(1e-9), lessThan(abs(direction), vec3(1e-9)));
  vec3 a = (params.low - eye) * slope, b = (params.low + box - eye) * slope;
  vec3 first = min(a, b), last = max(a, b);
  float from_m = max(max(first.x, max(first.y, first.z)), part_m.x);
  float to_m = min(min(last.x, min(last.y, last.z)), part_m.y);
  if (light_has(kLightScattering) && to_m > from_m) {
    // Light that arrives from s metres on fades as exp(-rate s), in the green (look_through of shared/water.glsl).
    float start_m = max(light.origin_depth_m - eye.y, 0.0), whole_m = part_m.y - part_m.x;
    float murk = murky_length(start_m, direction, whole_m) / whole_m;
    float rate = light.beam_attenuation.g * murk - light.diffuse_attenuation.g * direction.y;
    rate = abs(rate) < 1e-4 ? 1e-4 : rate;
    float length_m = to_m - from_m;
    float own = 1.0 - exp(-clamp(rate * length_m, -40.0, 40.0));
    float before = exp(-clamp(rate * (from_m - part_m.x), -40.0, 40.0));
    float all = 1.0 - exp(-clamp(rate * whole_m, -40.0, 40.0));
    // Bayer's order of the 16 places of a block.
    uvec2 bits = uvec2(at.xy) & 3u;
    uint x = bits.x ^ bits.y;
    uint order = ((x & 1u) << 3) | ((bits.y & 1u) << 2) | (x & 2u) | (bits.y >> 1);
    float turn = (float(order) + 0.5) / 16.0;
    float sum = 0.0;
    for (uint i = 0u; i < kSamples; ++i) {
      float share = (float(i) + turn) / float(kSamples);
      float way_m = from_m - log(max(1.0 - share * own, 1e-30)) / rate;
      sum += open_at(eye + direction * clamp(way_m, from_m, to_m));
    }
    float part = abs(all) > 1e-6 ? clamp(own * before / all, 0.0, 1.0) : 1.0;
    along = 1.0 + (sum / float(kSamples) - 1.0) * part;
  }
  imageStore(out_image, at, vec4(along, there, 1.0, 0.5 * visibility_distance(planar_m)));
}
