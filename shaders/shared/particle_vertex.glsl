// A particle's spot on the picture: where it is, how wide with its blur, its streak, and its light.
// A spot that would be narrower than a pixel and a half is as wide and fainter, so that it does not
// flicker. Three vertices a particle: a triangle about its spot, which a CPU driver draws faster than
// the two of a square. What is the same all over a spot is found here, also the whole light of a
// small bubble. NERITIC_PARTICLE_SHAFTS: light shafts fall on it. GLSL only.
#include "shared/bubble.h"
#include "shared/lighting.h"
#include "shared/particles.h"
#include "shared/visibility.h"

layout(constant_id = kSpecParticleKind) const uint kKind = kParticleSnow;
layout(constant_id = kSpecParticleMultiview) const bool kMultiview = true;
layout(constant_id = kSpecParticleCascades) const uint kCascades = 0;
const bool kBubbles = kKind == kParticleBubble || kKind == kParticleBubbleSpot;

layout(set = 0, binding = kParticleViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kParticleLighting, scalar) uniform Light { Lighting light; };
layout(set = 0, binding = kParticleStream, scalar) readonly buffer Stream { Particle particles[]; };
#ifdef NERITIC_PARTICLE_SHAFTS
layout(set = 0, binding = kParticleSun, scalar) uniform Sun { VisibilityParams sun; };
layout(set = 0, binding = kParticleCascades) uniform texture2DArray cascade_image;
layout(set = 0, binding = kParticleCaustics) uniform sampler2DArray caustics_image;
#endif
layout(push_constant, scalar) uniform Push { ParticlePush push; };

bool light_has(uint term) { return (light.terms & term) != 0u; }
uint lamp_count() { return light.lamp_count; }
uint glow_samples() { return 4u; }

#include "shared/water.glsl"

layout(location = 0) out vec2 place;       // pixels from the streak's middle: along, across
layout(location = 1) flat out vec3 shape;  // half streak, radius (pixels), opacity
layout(location = 2) flat out vec4 body;   // light that arrives from it, exposed; the opacity of a small bubble
layout(location = 3) flat out uint seed;
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

#include "shared/bubble_light.glsl"

#ifdef NERITIC_PARTICLE_SHAFTS
#include "shared/caustic_light.glsl"
#include "shared/sun_beam.glsl"

// The sun's beam at a particle over that in open water under a flat surface, as light shafts have
// it. wide_m: of the pixel there, or the particle.
float beam_at(vec3 at, float wide_m) {
  float lit = caustic_at(at, wide_m);
  if (kCascades > 0u)
    lit *= 1.0 - core_share(light.origin_depth_m - at.y) * (1.0 - sun_reaches(at));
  return lit;
}
#else
float beam_at(vec3 at, float wide_m) { return 1.0; }
#endif

// Share of even light that a small pale thing sends on. Aggregates of marine snow are translucent.
const vec3 kSnowAlbedo = vec3(0.55, 0.57, 0.55);
const vec3 kSiltAlbedo = vec3(0.42, 0.38, 0.30);

// Radiance of a diffuse sphere, as a mean over its disk: 2/3 of albedo / pi where light and eye are on one
// side (Lambert's sphere), falling to none; what passes through counts for a third.
float sphere_share(float cosine) { return (0.33 + 0.67 * (0.5 + 0.5 * cosine)) * 0.667 / kPi; }

// lit: of the sun's beam.
vec3 radiance_of(vec3 at, vec3 to_eye, vec3 albedo, float skylight, float lit) {
  vec3 sum = vec3(0.0);
  if (light_has(kLightSun)) {
    float depth_m = light.origin_depth_m - at.y;
    vec3 irradiance = downwelling(depth_m);
    vec3 direct = direct_share(depth_m);
    vec3 beam = irradiance * direct / light.sun_cosine * sphere_share(dot(light.to_sun, to_eye));
    // The beam's core is the sun's maps' to stop.
    sum += beam * mix(skylight, 1.0, core_share(depth_m)) * lit;
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
// lamp. lit: of the sun's beam.
void light_bubble(vec3 at, vec3 along, Sight sight, float skylight, float lit) {
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
    sun_light = vec4(irradiance * direct / light.sun_cosine * scale * lit * mix(skylight, 1.0, core_share(depth_m)),
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

// The mean over a bubble less than a pixel wide, from places on two rings: one where it lets light
// pass, one where it mirrors all (beyond 0.75 of its radius). Each ring weighs its share of the disk.
vec4 mean_bubble_light(float radius) {
  vec4 sum = vec4(0.0);
  [[unroll]] for (int i = 0; i < 6; ++i) {
    float angle = (float(i) + 0.25) * kPi / 3.0;
    float r = (i & 1) == 0 ? 0.53 : 0.88;
    vec2 spot = r * vec2(cos(angle), sin(angle));
    sum += ((i & 1) == 0 ? 0.56 : 0.44) / 3.0 *
           bubble_light(vec2(spot.x, spot.y / upright.z), sqrt(1.0 - r * r), radius);
  }
  return sum;
}

// Share of a spot's opacity in its streak, which has as much light in all: the spot's two halves and a bar between
// them. disk, across: of the spot's profile, the integral over it in squared radii and through its middle, across the
// streak, in radii. radius and streak in pixels.
float streak_share(float disk, float across, float radius, float streak) {
  return disk * radius / (disk * radius + across * streak);
}

void main() {
  int view = kMultiview ? gl_ViewIndex : 0;
  Particle particle = particles[gl_VertexIndex / 3];
  vec4 now = views[view].clip_from_origin * vec4(particle.position, 1.0);
  vec4 later = mix(views[view].clip_from_origin * vec4(particle.position + particle.moved, 1.0),
                   views[view].next_clip_from_origin * vec4(particle.position + particle.moved, 1.0), push.shutter);
  gl_Position = vec4(0.0, 0.0, -1.0, 1.0);  // nothing, unless it is before the camera
  place = vec2(0.0);
  shape = vec3(0.0);
  body = vec4(0.0);
  upright = along_sight = level_light = low_light = window_light = to_lamp = veil = vec3(0.0);
  sun_light = lamp_light = vec4(0.0);
  float skylight = 1.0 - float(particle.kind >> kParticleShadeShift) / 255.0;
  seed = particle.seed;
  flatness = vec4(0.0);
  if (!(now.w > views[view].near_m)) return;
  if (!(later.w > views[view].near_m)) later = now;
  vec2 half_size = 0.5 * push.target_size;
  vec2 a = now.xy / now.w * half_size, b = later.xy / later.w * half_size;
  vec2 along = b - a;
  float streak = length(along);
  along = streak > 1e-3 ? along / streak : vec2(1.0, 0.0);
  streak = min(streak, 0.25 * push.target_size.x);
  // Pixels a metre at that distance.
  vec3 from_eye = particle.position - views[view].eye;
  float distance_m = max(length(from_eye), 1e-3);
  vec3 to_eye = -from_eye / distance_m;
  float pixels_m =
      length(views[view].ray_dx) > 0.0 ? 1.0 / (length(views[view].ray_dx) * now.w) : 0.0;
  // It keeps its volume, so a flat one is wider. It wobbles as it rises, large ones more.
  float loose = smoothstep(0.0015, 0.004, particle.radius_m);
  float swing = float(particle.seed & 255u) * kWobbleTurn_rad;
  float aspect =
      kBubbles ? clamp(bubble_aspect(particle.radius_m) * (1.0 + 0.18 * loose * sin(swing)), 0.35, 1.0)
               : 1.0;
  float own = particle.radius_m * pow(aspect, -1.0 / 3.0) * pixels_m;
  float blur =
      0.5 * kLensOpening_m * abs(1.0 / now.w - 1.0 / kLensFocus_m) / length(views[view].ray_dx);
  float radius = kKind == kParticleSilt ? own : sqrt(own * own + blur * blur + 0.56);
  // A spot's light is spread over its blur and its streak; snow's soft disk has half the light of a flat one.
  float share = kKind == kParticleSilt ? 1.0 : (kKind == kParticleSnow ? 2.0 : 1.0) * own * own / (radius * radius);
  // Integrals of the fragment stages' profiles, with rho the way from the middle over the radius: of snow, 1 - rho^2,
  // pi / 2 over the disk and 4 / 3 across; of silt, (1 - rho^2)^2, pi / 3 and 16 / 15.
  if (!kBubbles) share *= streak_share(kKind == kParticleSnow ? kPi / 2.0 : kPi / 3.0,
                                       kKind == kParticleSnow ? 4.0 / 3.0 : 16.0 / 15.0, radius, streak);
  vec3 albedo = kKind == kParticleSilt ? kSiltAlbedo : kSnowAlbedo;
  Sight sight = look_through(light.origin_depth_m - views[view].eye.y, -to_eye, distance_m, 1.0, skylight);
  float lit = beam_at(particle.position, max(distance_m * length(views[view].ray_dx), 2.0 * particle.radius_m));
  if (kBubbles) {
    along_sight = -to_eye;
    light_bubble(particle.position, -to_eye, sight, skylight, lit);
    // Seen at an angle to the level a flat bubble is rounder.
    float seen = sqrt(aspect * aspect * (1.0 - to_eye.y * to_eye.y) + to_eye.y * to_eye.y);
    // Upwards on the picture, tilted by its swing.
    vec4 above = views[view].clip_from_origin * vec4(particle.position + vec3(0.0, 1e-2, 0.0), 1.0);
    vec2 axis = above.w > views[view].near_m ? above.xy / above.w * half_size - a : vec2(0.0);
    axis = dot(axis, axis) > 1e-8 ? normalize(axis) : vec2(0.0, -1.0);
    float tilt = 0.35 * loose * cos(swing + float((particle.seed >> 8) & 255u) * kWobbleTurn_rad) *
                 (1.0 - to_eye.y * to_eye.y);
    // No flatter than a pixel.
    seen = max(seen, min(0.9 / radius, 1.0));
    upright = vec3(cos(tilt) * axis.x - sin(tilt) * axis.y, sin(tilt) * axis.x + cos(tilt) * axis.y,
                   seen);
    // An ellipse, whose edge runs from full to none over a pixel and a half: the ramp adds 3 / 16 squared pixels.
    float across = 2.0 / length(vec2(dot(along, upright.xy), (along.x * upright.y - along.y * upright.x) / seen));
    share *= streak_share(kPi * seen * (1.0 + 0.1875 / (radius * radius)), across, radius, streak);
    if (kKind == kParticleBubbleSpot) body = mean_bubble_light(radius);
  } else {
    vec3 arriving = radiance_of(particle.position, to_eye, albedo, skylight, lit) * sight.transmittance;
    body = vec4(min((arriving + sight.added) * light.exposure, vec3(60000.0)), 1.0);
  }
  shape = vec3(0.5 * streak, radius, particle.opacity * share);
  flatness = vec4(distance_m, particle.radius_m, along);
  // A triangle about the spot: two sides touch the circles at the streak's ends, the third lies
  // along it. Without a streak its sides are equal. Only a bubble's edge reaches beyond its radius.
  float half_streak = 0.5 * streak;
  float reach = radius + (kKind == kParticleBubble ? 1.0 : kKind == kParticleBubbleSpot ? 0.75 : 0.0);
  float slope = reach / (half_streak + 1.7320508 * reach);  // of half the angle between sides
  float base = half_streak + reach / slope;
  int corner = gl_VertexIndex % 3;
  place = corner == 2 ? vec2(0.0, base * 2.0 * slope / (1.0 - slope * slope) - reach)
                      : vec2(corner == 0 ? -base : base, -reach);
  vec2 middle = a + along * (0.5 * streak);
  vec2 pixel = middle + along * place.x + vec2(-along.y, along.x) * place.y;
  gl_Position = vec4(pixel / half_size * now.w, now.z, now.w);
}
