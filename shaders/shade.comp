#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

// Shading in compute on the G-buffer: surface light, then the water between it and the eye.
#include "shared/octahedral.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kShadeViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kShadeLighting, scalar) uniform Light { Lighting light; };
layout(set = 0, binding = kShadeDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kShadeNormal) uniform texture2DArray normal_image;
layout(set = 0, binding = kShadeAlbedo) uniform texture2DArray albedo_image;
layout(set = 0, binding = kShadeMaterial) uniform texture2DArray material_image;
layout(set = 0, binding = kShadeEmissive) uniform texture2DArray emissive_image;
layout(set = 0, binding = kShadeHdr, rgba16f) writeonly uniform image2DArray hdr_image;

layout(set = 0, binding = kShadeSeen) uniform texture2DArray seen_image;

layout(constant_id = kSpecTerms) const uint kTerms = ~0u;
layout(constant_id = kSpecLamps) const uint kLamps = kMaxLamps;
bool light_has(uint term) { return (kTerms & term) != 0u; }
uint lamp_count() { return kLamps; }

#include "shared/surface.glsl"
#include "shared/visibility.glsl"

// The visibility image at a pixel: between its four nearest, the farther off in distance the less.
Seen seen_at(ivec3 at, ivec2 size, float planar_m) {
  if (!light_has(kLightSeen)) return kAllSeen;
  ivec2 seen_size = textureSize(seen_image, 0).xy;
  // Its pixel (x, y) was made for the picture's (x, y) or (2 x, 2 y).
  vec2 place = vec2(at.xy) * (seen_size == size ? 1.0 : 0.5);
  ivec2 corner = ivec2(place);
  vec2 part = place - vec2(corner);
  float own = visibility_distance(planar_m);
  vec4 sum = vec4(0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    vec4 seen = texelFetch(seen_image, ivec3(min(corner + offset, seen_size - 1), at.z), 0);
    vec2 w = mix(1.0 - part, part, vec2(offset));
    float weight = w.x * w.y * max(1.0 - abs(seen.a - own) * 40.0, 0.0) + 1e-5;
    sum += vec4(seen.rgb, 1.0) * weight;
  }
  sum.rgb /= sum.a;
  return Seen(sum.r, sum.g, sum.b);
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(hdr_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  // The layer by workgroup: so drivers see that a whole group reads one view.
  uint layer = gl_WorkGroupID.z;
  vec3 ray = views[layer].ray_corner + (float(at.x) + 0.5) * views[layer].ray_dx + (float(at.y) + 0.5) * views[layer].ray_dy;
  float eye_depth_m = light.origin_depth_m - views[layer].eye.y;
  float stretch = length(ray);
  vec3 direction = ray / stretch;
  float depth = texelFetch(depth_image, at, 0).r;
  bool hit = depth > 0.0;
  float planar_m = hit ? views[layer].near_m / depth : kForever_m;
  vec4 material = texelFetch(material_image, at, 0);
  vec3 emitted = light_has(kLightEmissive) ? texelFetch(emissive_image, at, 0).rgb * light.emissive_scale : vec3(0.0);
  Surface s;
  s.position = views[layer].eye + ray * planar_m;
  s.normal = octahedral_decode(texelFetch(normal_image, at, 0).rg);
  vec3 root_albedo = texelFetch(albedo_image, at, 0).rgb;
  s.albedo = root_albedo * root_albedo;
  s.roughness = material.x;
  s.metallic = material.y;
  s.occlusion = material.z;
  s.reflectance = material.w;
  vec3 radiance = emitted;
  if (material.w < 0.9) radiance += shade_surface(s, -direction, seen_at(at, size, planar_m));  // else unlit
  if (!hit) radiance = beyond(eye_depth_m, direction);
  Sight sight = look_through(eye_depth_m, direction, hit ? planar_m * stretch : kForever_m);
  radiance = radiance * sight.transmittance + sight.added;
  radiance += lamp_glow(views[layer].eye, direction, hit ? planar_m * stretch : kForever_m);
  imageStore(hdr_image, at, vec4(min(radiance * light.exposure, vec3(60000.0)), 1.0));
}
