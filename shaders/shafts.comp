#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

// The sun's light that water scatters into a sight, over what it would be without waves and shadows: samples
// along the sight, each standing for an equal share of that light, of the caustics' net and of the sun's maps.
// Samples of 16 neighbours differ, in an order that no frame changes; the blur that follows joins them.
#include "shared/lighting.h"
#include "shared/shafts.h"
#include "shared/shaft_texel.glsl"
#include "shared/visibility.glsl"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kShaftViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kShaftLighting, scalar) uniform Light { Lighting light_data; };
layout(set = 0, binding = kShaftVisibility, scalar) uniform Sun { VisibilityParams sun_data; };
layout(set = 0, binding = kShaftData, scalar) uniform Data { ShaftParams params; };
layout(set = 0, binding = kShaftDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kShaftCascades) uniform texture2DArray cascade_image;
layout(set = 0, binding = kShaftCaustics) uniform sampler2DArray caustics_image;
layout(set = 0, binding = kShaftOut, r32f) writeonly uniform image2DArray out_image;

layout(constant_id = kSpecShaftTerms) const uint kTerms = ~0u;
layout(constant_id = kSpecShaftCascades) const uint kCascades = 0;
layout(constant_id = kSpecShaftSamples) const uint kSamples = 1;
bool light_has(uint term) { return (kTerms & term) != 0u; }
uint lamp_count() { return 0u; }
uint glow_samples() { return 1u; }

#include "shared/even_light.glsl"
#include "shared/caustic_light.glsl"
#include "shared/water.glsl"

VisibilityParams sun;  // its maps

#include "shared/sun_beam.glsl"

void main() {
  uint layer = gl_WorkGroupID.z;
  vec3 eye = views[layer].eye, ray_corner = views[layer].ray_corner, ray_dx = views[layer].ray_dx, ray_dy = views[layer].ray_dy;
  float near_m = views[layer].near_m, farthest_m = params.reach_m;
  take_light();
  [[unroll]] for (uint c = 0u; c < kCascades; ++c) {
    sun.cascades[c].clip_from_origin = sun_data.cascades[c].clip_from_origin;
    sun.cascades[c].near_m = sun_data.cascades[c].near_m;
  }
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 out_size = imageSize(out_image).xy;
  if (at.x >= out_size.x || at.y >= out_size.y) return;
  ivec2 size = textureSize(depth_image, 0).xy;
  ivec2 full = min(at.xy * int(kShaftStep) + int(kShaftStep / 2u), size - 1);
  float depth = texelFetch(depth_image, ivec3(full, layer), 0).r;
  float planar_m = depth > 0.0 ? near_m / depth : 600.0;
  vec3 ray = ray_corner + (float(full.x) + 0.5) * ray_dx + (float(full.y) + 0.5) * ray_dy;
  float stretch = length(ray);
  vec3 direction = ray / stretch;
  float eye_depth_m = light.origin_depth_m - eye.y;
  vec2 part_m = water_part(eye_depth_m, direction, depth > 0.0 ? planar_m * stretch : kForever_m);
  float whole_m = part_m.y - part_m.x;
  float reach_m = min(whole_m, farthest_m);
  float ratio = 1.0;
  if (reach_m > 0.0) {
    // Light that arrives from s metres on fades as exp(-rate s), in the green (look_through of shared/water.glsl).
    float start_m = max(eye_depth_m, 0.0);
    float murk = murky_length(start_m, direction, whole_m) / whole_m;
    float rate = light.beam_attenuation.g * murk - light.diffuse_attenuation.g * direction.y;
    rate = abs(rate) < 1e-4 ? 1e-4 : rate;
    float reached = 1.0 - exp(-clamp(rate * reach_m, -40.0, 40.0));
    float all = 1.0 - exp(-clamp(rate * whole_m, -40.0, 40.0));
    // Bayer's order of the 16 places of a block.
    uvec2 b = uvec2(at.xy) & 3u;
    uint x = b.x ^ b.y;
    uint order = ((x & 1u) << 3) | ((b.y & 1u) << 2) | (x & 2u) | (b.y >> 1);
    float turn = (float(order) + 0.5) / 16.0;
    float sum = 0.0;
    for (uint i = 0u; i < kSamples; ++i) {
      float share = (float(i) + turn) / float(kSamples);
      float way_m = -log(max(1.0 - share * reached, 1e-30)) / rate;
      vec3 place = eye + direction * (part_m.x + min(way_m, reach_m));
      float lit = caustic_at(place, way_m * length(ray_dx) * float(kShaftStep));
      // Light that is scattered round a solid fills its shadow, as on surfaces.
      if (kCascades > 0u) lit *= 1.0 - core_share(light.origin_depth_m - place.y) * (1.0 - sun_reaches(place));
      sum += lit;
    }
    // A sight of next to no water scatters nothing: 0 / 0 must not reach the blur.
    float part = all > 1e-6 ? clamp(reached / all, 0.0, 1.0) : 1.0;
    ratio = 1.0 + (sum / float(kSamples) - 1.0) * part;
  }
  imageStore(out_image, at, vec4(packed_shaft(ratio, visibility_distance(planar_m))));
}
