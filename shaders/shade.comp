#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require

// Shading in compute on the G-buffer: surface light, then the water between it and the eye.
#include "shared/octahedral.h"
#include "shared/lighting.h"
#include "shared/waves.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(push_constant, scalar) uniform Push { ShadePush push; };
layout(set = 0, binding = kShadeViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kShadeLighting, scalar) uniform Light { Lighting light_data; };
layout(set = 0, binding = kShadeDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kShadeNormal) uniform texture2DArray normal_image;
layout(set = 0, binding = kShadeAlbedo) uniform texture2DArray albedo_image;
layout(set = 0, binding = kShadeMaterial) uniform texture2DArray material_image;
layout(set = 0, binding = kShadeEmissive) uniform texture2DArray emissive_image;
layout(set = 0, binding = kShadeHdr, rgba16f) writeonly uniform image2DArray hdr_image;
layout(set = 0, binding = kShadeScattered, rgba16f) writeonly uniform image2DArray scattered_image;
layout(set = 0, binding = kShadeWaves, scalar) uniform Sea { Waves sea_data; };
layout(set = 0, binding = kShadeTiles, scalar) readonly buffer Tiles { uint tiles[]; };

layout(set = 0, binding = kShadeSeen) uniform texture2DArray seen_image;
layout(set = 0, binding = kShadeCaustics) uniform sampler2DArray caustics_image;
layout(set = 0, binding = kShadeShafts) uniform texture2DArray shafts_image;
layout(set = 0, binding = kShadeSkylight) uniform texture2DArray skylight_image;
layout(set = 0, binding = kShadeLampMaps) uniform texture2DArray lamp_maps;
layout(set = 0, binding = kShadeLampShadows, scalar) uniform Shadows { LampShadows lamp_shadow_data; };

layout(constant_id = kSpecTerms) const uint kTerms = ~0u;
layout(constant_id = kSpecLamps) const uint kLamps = kMaxLamps;
layout(constant_id = kSpecSeenStep) const uint kSeenStep = 2;
layout(constant_id = kSpecSeaSeen) const bool kSeaSeen = true;
layout(constant_id = kSpecGlowSamples) const uint kGlowSamples = 4;
layout(constant_id = kSpecTiled) const bool kTiled = false;
layout(constant_id = kSpecSurfaces) const bool kSurfaces = true;
bool light_has(uint term) { return (kTerms & term) != 0u; }
uint lamp_count() { return kLamps; }
uint glow_samples() { return kGlowSamples; }

#include "shared/even.glsl"
#include "shared/even_light.glsl"
#include "shared/caustic_light.glsl"
#include "shared/shafts.h"
#include "shared/skylight.h"
#include "shared/shaft_texel.glsl"
#include "shared/surface.glsl"
#include "shared/sea_surface.glsl"
#include "shared/visibility.glsl"

LampShadows lamp_shadows;
void take_lamp_shadows() {
  lamp_shadows.near_m = lamp_shadow_data.near_m;
  NERITIC_OVER_LAMPS lamp_shadows.layer[i] = lamp_shadow_data.layer[i];
  [[unroll]] for (uint i = 0u; i < min(lamp_count(), kMaxLampShadows); ++i)
    lamp_shadows.clip_from_origin[i] = lamp_shadow_data.clip_from_origin[i];
}

// The lamp's map, between four texels.
float lamp_seen(uint lamp, vec3 position, vec3 normal) {
  uint own = lamp_shadows.layer[lamp], layer = min(own, kMaxLampShadows - 1u);
  mat4 clip_from_origin = mat4(1.0);
  [[unroll]] for (uint i = 0u; i < min(lamp_count(), kMaxLampShadows); ++i)
    if (layer == i) clip_from_origin = lamp_shadows.clip_from_origin[i];
  vec4 clip = clip_from_origin * vec4(position + normal * 0.01, 1.0);
  int size = textureSize(lamp_maps, 0).x;
  vec2 place = (clip.xy / max(clip.w, 1e-3) * 0.5 + 0.5) * float(size) - 0.5;
  vec2 corner = floor(place), part = place - corner;
  // A texel's slope at grazing sight, at that distance.
  float limit_m = clip.w * (1.0 - 3.0 / float(size)) - 0.01;
  float seen = 0.0, near_m = lamp_shadows.near_m;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    vec2 offset = vec2(i & 1, i >> 1);
    ivec2 at = clamp(ivec2(corner + offset), ivec2(0), ivec2(size - 1));
    float depth = texelFetch(lamp_maps, ivec3(at, layer), 0).r;
    vec2 w = mix(1.0 - part, part, offset);
    if (depth * limit_m <= near_m) seen += w.x * w.y;
  }
  return own >= kMaxLampShadows || clip.w < near_m ? 1.0 : seen;
}

// The shafts image at a pixel: between its four nearest, the farther off in distance the less.
float lit_at(ivec3 at, float planar_m) {
  if (!light_has(kLightShafts)) return 1.0;
  ivec2 shaft_size = textureSize(shafts_image, 0).xy;
  // Its pixel (x, y) was made for the picture's kShaftStep times (x, y) and half a step.
  vec2 place = max((vec2(at.xy) - float(kShaftStep / 2u)) / float(kShaftStep), vec2(0.0));
  ivec2 corner = ivec2(place);
  vec2 part = place - vec2(corner);
  float own = visibility_distance(planar_m);
  vec2 sum = vec2(0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    vec2 seen = unpacked_shaft(
        texelFetch(shafts_image, ivec3(min(corner + offset, shaft_size - 1), at.z), 0).r);
    vec2 w = mix(1.0 - part, part, vec2(offset));
    sum +=
        vec2(seen.x, 1.0) * (w.x * w.y * (max(1.0 - abs(seen.y - own) * 20.0, 0.0) + 1e-3) + 1e-6);
  }
  return sum.x / sum.y;
}

// An image made for one pixel of every `step` a side, at a pixel: between its four nearest, the less the farther
// their keys (alpha) are from its own.
vec3 from_coarser(texture2DArray image, float step, ivec3 at, float own) {
  ivec2 last = textureSize(image, 0).xy - 1;
  // Its pixel (x, y) was made for the picture's step times (x, y).
  vec2 place = vec2(at.xy) / step;
  ivec2 corner = ivec2(place);
  vec2 part = place - vec2(corner);
  vec4 sum = vec4(0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    vec4 texel = texelFetch(image, ivec3(min(corner + offset, last), at.z), 0);
    vec2 w = mix(1.0 - part, part, vec2(offset));
    float weight = w.x * w.y * max(1.0 - abs(texel.a - own) * 80.0, 0.0) + 1e-5;
    sum += vec4(texel.rgb, 1.0) * weight;
  }
  return sum.rgb / sum.a;
}

Seen seen_at(ivec3 at, float planar_m, vec3 normal) {
  Seen seen = kAllSeen;
  if (!light_has(kLightSeen)) return seen;
  vec3 shares = from_coarser(seen_image, float(kSeenStep), at, visibility_key(planar_m, normal, light.to_sun));
  seen.sun = shares.r;
  seen.sky = shares.g;
  seen.around = shares.b;
  return seen;
}

// Along the sight, and at its end.
vec2 skylight_at(ivec3 at, float planar_m) {
  if (!light_has(kLightSkylight)) return vec2(1.0);
  return from_coarser(skylight_image, float(kSkylightStep), at, 0.5 * visibility_distance(planar_m)).rg;
}

// Looks from a place on the sea along a mirrored sight for things that the picture shows too, hulls for example, up to 6 m
// away. Gives their radiance, lit by the sun and the sky without shadows, and 1 in w; all 0 if there is nothing.
vec4 mirrored_at(vec3 from, vec3 way, uint layer) {
  vec3 eye = views[layer].eye, dx = views[layer].ray_dx, dy = views[layer].ray_dy, corner = views[layer].ray_corner;
  float near_m = views[layer].near_m, before_m = 0.0, dx2 = dot(dx, dx), dy2 = dot(dy, dy);
  vec3 ahead = cross(dx, dy);
  ahead /= dot(ahead, corner);
  ivec2 size = textureSize(depth_image, 0).xy;
  for (float far_m = 0.08; far_m < 6.0; far_m = far_m * 1.25 + 0.04) {
    vec3 to = from + way * far_m - eye;
    float planar_m = dot(to, ahead);
    if (planar_m < near_m) break;
    vec3 on = to / planar_m - corner;
    ivec2 at = ivec2(floor(vec2(dot(on, dx) / dx2, dot(on, dy) / dy2)));
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) break;
    float depth = texelFetch(depth_image, ivec3(at, layer), 0).r;
    float behind_m = depth > 0.0 && depth < 1.0 ? planar_m - near_m / depth : -1.0;
    if (behind_m > 0.0 && behind_m < far_m - before_m + 0.3) {
      vec4 root = texelFetch(albedo_image, ivec3(at, layer), 0);
      vec3 normal = octahedral_decode(texelFetch(normal_image, ivec3(at, layer), 0).rg), sun = sun_in_air();
      vec3 light_on = beam_in_air(sun) * max(dot(normal, sun), 0.0) +
                      light.surface_irradiance * ((1.0 - light.direct_share) * (0.5 + 0.5 * normal.y));
      return vec4(root.rgb * root.rgb * light_on / kPi, 1.0);
    }
    before_m = far_m;
  }
  return vec4(0.0);
}

void main() {
  // The layer by workgroup: so drivers see that a whole group reads one view.
  uint layer = kTiled ? 0u : gl_WorkGroupID.z;
  vec3 eye = views[layer].eye, ray_dx = views[layer].ray_dx, ray_dy = views[layer].ray_dy;
  vec3 ray_corner = views[layer].ray_corner;
  float near_m = views[layer].near_m, pixel_rad = length(ray_dx);
  take_light();
  if (light_has(kLightSurface)) take_sea();
  if (light_has(kLightLampShadows)) take_lamp_shadows();
  ivec3 at = ivec3(gl_GlobalInvocationID);
  at.y += int(push.first_group * kShadeGroup);
  if (kTiled) {  // of one layer
    uint tile = tiles[push.first_tile + gl_WorkGroupID.x];
    at = ivec3(uvec2(tile & 0xffffu, tile >> 16) * kShadeGroup + gl_LocalInvocationID.xy, 0);
  }
  ivec2 size = imageSize(hdr_image).xy;
  // Lanes beyond the picture go along, as loops over waves need all; what they store out there is dropped.
  ivec3 to = at;
  at.xy = min(at.xy, size - 1);
  vec3 ray = ray_corner + (float(at.x) + 0.5) * ray_dx + (float(at.y) + 0.5) * ray_dy;
  float eye_depth_m = light.origin_depth_m - eye.y;
  float stretch = length(ray);
  vec3 direction = ray / stretch;
  float depth = texelFetch(depth_image, at, 0).r;
  bool hidden = depth >= 1.0;  // from the wearer (hidden.vert), or on the near plane itself
  if (hidden) depth = 0.0;
  bool hit = kSurfaces && depth > 0.0;
  float planar_m = hit ? near_m / depth : kForever_m;
  vec4 material = texelFetch(material_image, at, 0);
  vec3 emitted = kSurfaces && light_has(kLightEmissive) ? texelFetch(emissive_image, at, 0).rgb * light.emissive_scale : vec3(0.0);
  Surface s;
  s.position = eye + ray * planar_m;
  s.normal = octahedral_decode(texelFetch(normal_image, at, 0).rg);
  vec4 root_albedo = texelFetch(albedo_image, at, 0);
  s.albedo = root_albedo.rgb * root_albedo.rgb;
  s.through = 1.0 - root_albedo.a;
  s.roughness = material.x;
  s.metallic = material.y;
  s.occlusion = material.z;
  s.reflectance = material.w;
  vec3 radiance = emitted;
  vec2 skylight = skylight_at(at, hit ? planar_m : kForever_m);
  if (kSurfaces && material.w < 0.9) {
    Seen seen = seen_at(at, planar_m, s.normal);
    seen.caustic = caustic_at(s.position, planar_m * pixel_rad);
    seen.skylight = skylight.y;
    radiance += shade_surface(s, -direction, seen);
  }  // else unlit
  float sight_m = hit ? planar_m * stretch : kForever_m;
  SeaPoint surface;
  bool meets = false, from_above = false;
  if (light_has(kLightSurface)) {
    // A camera looks through its near plane as through a housing's window: where that is in the air, so is the sight.
    // So the surface parts the picture of one that is half in the water.
    vec3 window = eye + ray * near_m;
    from_above = window.y - light.origin_depth_m >= sea_over_eye(window.xz);
    meets = kSeaSeen && sea_meets(eye, direction, from_above, pixel_rad, sight_m, surface);
    meets = meets && surface.distance_m < sight_m;
    if (meets && !from_above) {
      // From below nothing above the water is seen but the sky.
      radiance = sea_from_below(surface, eye, direction, pixel_rad);
      hit = false;
      sight_m = surface.distance_m;
    } else if (!hit) {
      radiance = from_above && !meets ? sky_and_sun(direction, pixel_rad) : vec3(0.0);
    }
    // So that the still surface lies where the sight meets the waves.
    if (meets) eye_depth_m = max(from_above ? -1e9 : 0.0, surface.distance_m * direction.y);
    else if (from_above) eye_depth_m = -1e9;
    else eye_depth_m = max(eye_depth_m + sea_over_eye(eye.xz), 1e-3);
  } else if (!hit) {
    radiance = light_has(kLightWater) ? vec3(0.0) : light.background;
  }
  Sight sight = look_through(eye_depth_m, direction, sight_m, lit_at(at, planar_m), skylight.x);
  if (light_has(kLightForwardScatter)) {
    // How much lighter than the water there, with what scatters forwards on the way, and the distance.
    vec3 kept = (radiance - sight.water) * kept_forwards(sight.length_m) * light.exposure;
    imageStore(scattered_image, to, hit && !hidden ? vec4(clamp(kept, vec3(-60000.0), vec3(60000.0)), sight.length_m) : vec4(0.0));
  }
  radiance = radiance * sight.transmittance + sight.added;
  if (light_has(kLightSurface) && meets && from_above) {
    vec3 place = eye + direction * surface.distance_m;
    surface = rippled(surface, place.xz, pixel_rad * surface.distance_m * inversesqrt(max(-direction.y, 0.05)));
    vec3 normal = sea_normal(surface);
    vec3 way = sea_mirror(direction, normal, max(dot(-direction, normal), 0.0));
    vec4 mirrored = mirrored_at(place, way, layer);
    radiance = sea_from_above(surface, eye, direction, radiance, mirrored, pixel_rad);
  }
  radiance += lamp_glow(eye, direction, sight_m);
  if (hidden) radiance = vec3(0.0);
  imageStore(hdr_image, to, vec4(min(radiance * light.exposure, vec3(60000.0)), 1.0));
}
