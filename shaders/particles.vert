#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_multiview : require

// A particle's spot on the picture: where it is, how wide with its blur, its streak, and its light.
// A spot that would be narrower than a pixel and a half is as wide and fainter, so that it does not
// flicker.
#include "shared/bubble.h"
#include "shared/lighting.h"
#include "shared/particles.h"

layout(constant_id = kSpecBubbles) const bool kBubbles = false;
layout(constant_id = kSpecParticleMultiview) const bool kMultiview = true;

layout(location = kParticlePosition) in vec4 in_position;
layout(location = kParticleMoved) in vec4 in_moved;
layout(location = kParticleKind) in uvec2 in_kind;

layout(set = 0, binding = kParticleViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kParticleLighting, scalar) uniform Light { Lighting light; };
layout(push_constant, scalar) uniform Push { ParticlePush push; };

bool light_has(uint term) { return (light.terms & term) != 0u; }
uint lamp_count() { return light.lamp_count; }
uint glow_samples() { return 4u; }

#include "shared/water.glsl"

layout(location = 0) out vec2 place;       // pixels from the streak's middle: along, across
layout(location = 1) flat out vec3 shape;  // half streak, radius (pixels), opacity
layout(location = 2) flat out vec3 body;   // radiance that arrives from an opaque one, exposed
layout(location = 3) flat out uvec2 kind;
layout(location = 4) flat out vec4 flatness;  // distance (m), radius (m), direction of the streak
// A bubble's short axis on the picture and its height over its width there; the way from the
// eye; radiances about it (exposed, as they arrive), and what the water before it adds.
layout(location = 5) flat out vec3 upright;
layout(location = 6) flat out vec3 along_sight;
layout(location = 7) flat out vec3 level_light;
layout(location = 8) flat out vec3 low_light;
layout(location = 9) flat out vec3 window_light;
layout(
    location = 10) flat out vec4 sun_light;  // of the beam's irradiance; variance of its directions
layout(location = 11) flat out vec4 lamp_light;  // of the strongest lamp's, and the same
layout(location = 12) flat out vec3 to_lamp;
layout(location = 13) flat out vec3 veil;
layout(location = 14) flat out vec4 lit_at;  // its place, and the share of the beam's core

// Share of even light that a small pale thing sends on. Aggregates of marine snow are translucent.
const vec3 kSnowAlbedo = vec3(0.55, 0.57, 0.55);
const vec3 kSiltAlbedo = vec3(0.42, 0.38, 0.30);

// Radiance of a diffuse sphere, as a mean over its disk: 2/3 of albedo / pi where light and eye are on one
// side (Lambert's sphere), falling to none; what passes through counts for a third.
float sphere_share(float cosine) { return (0.33 + 0.67 * (0.5 + 0.5 * cosine)) * 0.667 / kPi; }

// beam: what of it comes straight from the sun.
vec3 radiance_of(vec3 at, vec3 to_eye, vec3 albedo, float skylight, out vec3 beam) {
  vec3 sum = vec3(0.0);
  beam = vec3(0.0);
  if (light_has(kLightSun)) {
    float depth_m = light.origin_depth_m - at.y;
    vec3 irradiance = downwelling(depth_m);
    vec3 direct = direct_share(depth_m);
    beam = irradiance * direct / light.sun_cosine * sphere_share(dot(light.to_sun, to_eye));
    // The beam's core is the sun's maps' to stop.
    beam *= mix(skylight, 1.0, core_share(depth_m));
    sum += beam;
    beam *= albedo;
    sum += irradiance * (1.0 - direct) * sphere_share(to_eye.y) * 1.3 * skylight;
  }
  for (uint i = 0u; i < lamp_count(); ++i) {
    vec3 to_lamp = light.lamps[i].position - at;
    float distance_m = max(length(to_lamp), 0.05);
    to_lamp /= distance_m;
    float cone = beam_of(i, dot(-to_lamp, light.lamps[i].direction));
    vec3 arriving = light.lamps[i].intensity_cd * cone / (distance_m * distance_m + 0.0025);
    if (light_has(kLightWater)) arriving *= exp(-min(light.beam_attenuation * distance_m, vec3(80.0)));
    sum += arriving * sphere_share(dot(to_lamp, to_eye));
  }
  return sum * albedo;
}

// The light that a bubble mirrors and lets through: from the water about it, Snell's cone, sun and
// lamp.
void light_bubble(vec3 at, vec3 along, Sight sight, float skylight) {
  float depth_m = light.origin_depth_m - at.y;
  vec3 scale = sight.transmittance * light.exposure;
  vec3 level = normalize(vec3(along.x, 0.02 * sign(along.y), along.z) + vec3(1e-6, 0.0, 0.0));
  level_light = look_through(depth_m, level, kForever_m, 1.0, skylight).added * scale;
  low_light = look_through(depth_m, vec3(0.0, -1.0, 0.0), kForever_m, 1.0, skylight).added * scale;
  if (light_has(kLightSun)) {
    vec3 irradiance = downwelling(depth_m), direct = direct_share(depth_m);
    // Even light from within 48.6 degrees of the zenith: irradiance = pi sin^2 radiance.
    window_light = irradiance * (1.0 - direct) * (skylight * kWaterIndex * kWaterIndex / kPi) * scale;
    // The waves' spread of 10 degrees, and what the water has turned by small angles
    // (visibility.h).
    sun_light = vec4(irradiance * direct / light.sun_cosine * scale * mix(skylight, 1.0, core_share(depth_m)),
                     0.03 + 0.02 * light.particle_scattering.g * max(depth_m, 0.0));
  }
  for (uint i = 0u; i < lamp_count(); ++i) {
    vec3 way = light.lamps[i].position - at;
    float distance_m = max(length(way), 0.05);
    way /= distance_m;
    float cone = beam_of(i, dot(-way, light.lamps[i].direction));
    vec3 arriving = light.lamps[i].intensity_cd * cone / (distance_m * distance_m + 0.0025);
    if (light_has(kLightWater))
      arriving *= exp(-min(light.beam_attenuation * distance_m, vec3(80.0)));
    if (arriving.g * scale.g <= lamp_light.g) continue;
    lamp_light = vec4(arriving * scale, 0.004);
    to_lamp = way;
  }
  veil = sight.added * light.exposure;
}

void main() {
  int view = kMultiview ? gl_ViewIndex : 0;
  vec4 now = views[view].clip_from_origin * vec4(in_position.xyz, 1.0);
  vec4 later = mix(views[view].clip_from_origin * vec4(in_position.xyz + in_moved.xyz, 1.0),
                   views[view].next_clip_from_origin * vec4(in_position.xyz + in_moved.xyz, 1.0), push.shutter);
  gl_Position = vec4(0.0, 0.0, -1.0, 1.0);  // nothing, unless it is before the camera
  place = vec2(0.0);
  shape = body = vec3(0.0);
  upright = along_sight = level_light = low_light = window_light = to_lamp = veil = vec3(0.0);
  sun_light = lamp_light = vec4(0.0);
  uint own_kind = in_kind.x & kParticleKindMask;
  float skylight = 1.0 - float(in_kind.x >> kParticleShadeShift) / 255.0;
  kind = uvec2(own_kind, in_kind.y);
  flatness = vec4(0.0);
  lit_at = vec4(in_position.xyz, core_share(light.origin_depth_m - in_position.y));
  if (!(now.w > views[view].near_m)) return;
  if (!(later.w > views[view].near_m)) later = now;
  vec2 half_size = 0.5 * push.target_size;
  vec2 a = now.xy / now.w * half_size, b = later.xy / later.w * half_size;
  vec2 along = b - a;
  float streak = length(along);
  along = streak > 1e-3 ? along / streak : vec2(1.0, 0.0);
  streak = min(streak, 0.25 * push.target_size.x);
  // Pixels a metre at that distance.
  vec3 from_eye = in_position.xyz - views[view].eye;
  float distance_m = max(length(from_eye), 1e-3);
  vec3 to_eye = -from_eye / distance_m;
  float pixels_m =
      length(views[view].ray_dx) > 0.0 ? 1.0 / (length(views[view].ray_dx) * now.w) : 0.0;
  // It keeps its volume, so a flat one is wider. It wobbles as it rises, large ones more.
  float loose = smoothstep(0.0015, 0.004, in_position.w);
  float swing = float(in_kind.y & 255u) * kWobbleTurn_rad;
  float aspect =
      kBubbles ? clamp(bubble_aspect(in_position.w) * (1.0 + 0.18 * loose * sin(swing)), 0.35, 1.0)
               : 1.0;
  float own = in_position.w * pow(aspect, -1.0 / 3.0) * pixels_m;
  float blur =
      0.5 * kLensOpening_m * abs(1.0 / now.w - 1.0 / kLensFocus_m) / length(views[view].ray_dx);
  float radius = own_kind == kParticleSilt ? own : sqrt(own * own + blur * blur + 0.56);
  // A spot's light is spread over its blur and its streak; snow's soft disk has half the light of a flat one.
  float share = own_kind == kParticleSilt ? 1.0 : (own_kind == kParticleSnow ? 2.0 : 1.0) * own * own / (radius * radius) * (radius * kPi / (radius * kPi + 2.0 * streak));
  vec3 albedo = own_kind == kParticleSilt ? kSiltAlbedo : kSnowAlbedo;
  Sight sight = look_through(light.origin_depth_m - views[view].eye.y, -to_eye, distance_m, 1.0, skylight);
  if (kBubbles) {
    along_sight = -to_eye;
    light_bubble(in_position.xyz, -to_eye, sight, skylight);
    // Seen at an angle to the level a flat bubble is rounder.
    float seen = sqrt(aspect * aspect * (1.0 - to_eye.y * to_eye.y) + to_eye.y * to_eye.y);
    // Upwards on the picture, tilted by its swing.
    vec4 above = views[view].clip_from_origin * vec4(in_position.xyz + vec3(0.0, 1e-2, 0.0), 1.0);
    vec2 axis = above.w > views[view].near_m ? above.xy / above.w * half_size - a : vec2(0.0);
    axis = dot(axis, axis) > 1e-8 ? normalize(axis) : vec2(0.0, -1.0);
    float tilt = 0.35 * loose * cos(swing + float((in_kind.y >> 8) & 255u) * kWobbleTurn_rad) *
                 (1.0 - to_eye.y * to_eye.y);
    // No flatter than a pixel.
    seen = max(seen, min(0.9 / radius, 1.0));
    upright = vec3(cos(tilt) * axis.x - sin(tilt) * axis.y, sin(tilt) * axis.x + cos(tilt) * axis.y,
                   seen);
  } else {
    vec3 beam;
    body = (radiance_of(in_position.xyz, to_eye, albedo, skylight, beam) * sight.transmittance + sight.added) *
           light.exposure;
    body = min(body, vec3(60000.0));
    sun_light.rgb = min(beam * sight.transmittance * light.exposure, vec3(60000.0));
  }
  shape = vec3(0.5 * streak, radius, in_moved.w * share);
  flatness = vec4(distance_m, in_position.w, along);
  // Corners of the strip, a pixel wider than the spot.
  vec2 corner = vec2((gl_VertexIndex & 1) == 0 ? -1.0 : 1.0, (gl_VertexIndex & 2) == 0 ? -1.0 : 1.0);
  place = corner * vec2(0.5 * streak + radius + 1.0, radius + 1.0);
  vec2 middle = a + along * (0.5 * streak);
  vec2 pixel = middle + along * place.x + vec2(-along.y, along.x) * place.y;
  gl_Position = vec4(pixel / half_size * now.w, now.z, now.w);
}
