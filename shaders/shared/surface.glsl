// Light on a surface: Lambert and GGX (Walter et al. 2007; height-correlated Smith, Heitz 2014;
// Fresnel by Schlick 1994), under sun, diffuse water light and lamps. GLSL only.
#ifndef NERITIC_SURFACE_GLSL
#define NERITIC_SURFACE_GLSL
#include "shared/even.glsl"
#include "shared/visibility.h"
#include "shared/water.glsl"

struct Surface {
  vec3 position;  // relative to the origin
  vec3 normal;    // towards the eye
  vec3 albedo;
  float roughness;
  float metallic;
  float occlusion;
  float reflectance;  // (n - 1) / (n + 1)
  float through;      // of the diffuse light, with kLightThin: the share that leaves on the other side
};

// Reflectance of a dielectric at normal incidence (Fresnel): n = 1.5 gives 0.04 in air, 0.0035 in water,
// which is why wet things look dull under water. An index below water's counts as water's.
float dielectric_f0(Surface s) {
  float n = (1.0 + s.reflectance) / (1.0 - s.reflectance);
  float r = light_has(kLightWater) ? max((n - kWaterIndex) / (n + kWaterIndex), 0.0) : s.reflectance;
  return r * r;
}

// Share of even light that GGX sends on where its Fresnel term is 1 (single scattering, mean over all
// directions): 0.96 at roughness 0.1, 0.60 at 0.8, 0.41 at 1, by quadrature. That of 0.8 stands for all that is no
// metal: in water such a surface mirrors under a hundredth of the light.
const float kEvenReflectance = 0.6;
// Share of the light from above that comes back from below. In water an irradiance reflectance of some
// percent (Jerlov 1976), in shallow places the sand's; in air the albedo of dry, light ground (soils 0.05 to
// 0.40, deserts 0.20 to 0.45: Oke 1987, Boundary Layer Climates, table 1.1).
const float kWaterFromBelow = 0.08, kGroundFromBelow = 0.35;

// Share of even light that GGX sends on: f0 * x + y. Fitted to quadrature: within 0.11 (0.04 rms), y within 0.06.
vec2 even_reflectance(float roughness, float n_v) {
  float r2 = roughness * roughness;
  float p = 1.0 - n_v;
  float grazing = p * p * p * p * p / (1.0 + 20.0 * r2 * roughness);
  return vec2(1.0 - r2 * (0.32 + 0.47 * roughness * n_v) - grazing, grazing);
}

// Share of even light that a metal of reflectance f0 sends on, with what bounces on between the facets until it
// leaves: all of it where f0 is 1 (Turquin 2019, "Practical multiple scattering compensation for microfacet models").
vec3 even_metal(vec3 f0, float roughness, float n_v) {
  vec2 once = even_reflectance(roughness, n_v);
  return (f0 * once.x + once.y) * (1.0 + f0 * (1.0 / (once.x + once.y) - 1.0));
}

// BRDF times cosine. spread: half-angle of the source in radians; a highlight is no narrower.
vec3 reflect_light(Surface s, vec3 to_eye, vec3 to_light, float spread) {
  float n_l = dot(s.normal, to_light);
  if (n_l <= 0.0) return vec3(0.0);
  float n_v = max(dot(s.normal, to_eye), 1e-3);
  vec3 h = normalize(to_eye + to_light);
  float n_h = max(dot(s.normal, h), 0.0);
  float alpha = max(s.roughness * s.roughness, spread);
  float a2 = alpha * alpha;
  float d = n_h * n_h * (a2 - 1.0) + 1.0;
  float distribution = a2 / (kPi * d * d);
  float visibility = 0.5 / (n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2));
  vec3 f0 = mix(vec3(dielectric_f0(s)), s.albedo, s.metallic);
  float one_minus = 1.0 - max(dot(h, to_eye), 0.0);
  float p5 = one_minus * one_minus;
  p5 = p5 * p5 * one_minus;
  vec3 fresnel = f0 + (1.0 - f0) * p5;
  vec3 diffuse = s.albedo * (1.0 - s.metallic) * (1.0 - fresnel) / kPi;
  if (light_has(kLightThin)) diffuse *= 1.0 - s.through;
  return (diffuse + fresnel * distribution * visibility) * n_l;
}

// Light that reaches a surface, 1 where nothing stands between: of the sun's beam, of the light round it, of the
// surroundings.
struct Seen {
  float sun;
  float sky;
  float around;
  float caustic;   // the beam's light over that under flat water
  float skylight;  // of the light from above, what the still surroundings let through
};
const Seen kAllSeen = Seen(1.0, 1.0, 1.0, 1.0, 1.0);
// Share of a lamp that the place sees. The including file defines it.
float lamp_seen(uint lamp, vec3 position, vec3 normal);

// BRDF times cosine of the light that comes through a thin sheet from behind: diffuse.
vec3 transmit_light(Surface s, vec3 to_light) {
  if (!light_has(kLightThin)) return vec3(0.0);
  return s.albedo * ((1.0 - s.metallic) * s.through * max(-dot(s.normal, to_light), 0.0) / kPi);
}

// Share from above of the even light about a surface whose normal has this height. Diffuse light comes mostly from
// above.
float from_above(float normal_y) {
  float up = 0.5 + 0.5 * normal_y;
  return up * up * (3.0 - 2.0 * up);
}

// The same of what a metal mirrors: if smooth, of light from one direction. The cosine about a normal lets 2/3 of a
// linear term pass (Ramamoorthi and Hanrahan 2001), and from_above has 0.6 of one: a direction's light has 0.9.
float from_above_mirrored(vec3 normal, vec3 to_eye, float n_v, float roughness) {
  float mirrored_y = 2.0 * n_v * normal.y - to_eye.y;
  return mix(clamp(0.5 + 0.9 * mirrored_y, 0.0, 1.0), from_above(normal.y), roughness * roughness);
}

// Even light of which the share `above` comes from above, the rest from below: its irradiance, and pi times its radiance.
vec3 even_light(float above, vec3 irradiance, vec3 direct, float depth_m, Seen seen) {
  float from_below = light_has(kLightWater) ? kWaterFromBelow : kGroundFromBelow;
  if (light_has(kLightAmbient))
    return irradiance * ((1.0 - direct) * above * seen.sky + (from_bottom(depth_m) + 0.02) * (1.0 - above));
  return irradiance * (1.0 - direct) * mix(from_below, 1.0, above);
}

// Radiance that the surface sends towards the eye (before the water between).
vec3 shade_surface(Surface s, vec3 to_eye, Seen seen) {
  vec3 radiance = vec3(0.0);
  if (light_has(kLightSun)) {
    float depth_m = light.origin_depth_m - s.position.y;
    vec3 irradiance = downwelling(depth_m);
    vec3 direct = direct_share(depth_m);
    // The sun's disk has a half-angle of 4.7 mrad; waves spread its beam below them over some 10 degrees
    // (slopes of Cox and Munk 1954 at a light breeze).
    float sun_spread = light_has(kLightWater) ? 0.17 : 0.0047;
    vec3 beam = irradiance * direct / light.sun_cosine;
    if (light_has(kLightSeen) || light_has(kLightSkylight))
      beam *= mix(min(seen.sky, seen.skylight), seen.sun, core_share(depth_m));
    if (light_has(kLightCaustics)) beam *= seen.caustic;
    radiance += beam * reflect_light(s, to_eye, light.to_sun, sun_spread);
    radiance += beam * transmit_light(s, light.to_sun);
    vec3 around = even_light(from_above(s.normal.y), irradiance, direct, depth_m, seen);
    if (light_has(kLightThin))
      around = mix(around, even_light(from_above(-s.normal.y), irradiance, direct, depth_m, seen), s.through);
    vec3 plain_color = (s.albedo + dielectric_f0(s) * kEvenReflectance) * (1.0 - s.metallic);
    radiance += around * s.occlusion * seen.around * seen.skylight * plain_color / kPi;
    if (for_any(s.metallic > 0.0)) {
      float n_v = clamp(dot(s.normal, to_eye), 0.0, 1.0);
      float above = from_above_mirrored(s.normal, to_eye, n_v, s.roughness);
      vec3 mirrored = even_light(above, irradiance, direct, depth_m, seen) * even_metal(s.albedo, s.roughness, n_v) * s.metallic;
      radiance += mirrored * s.occlusion * seen.around * seen.skylight / kPi;
    }
  }
  NERITIC_OVER_LAMPS {
    vec3 to_lamp = light.lamps[i].position - s.position;
    float distance_m = max(length(to_lamp), 1e-3);
    to_lamp /= distance_m;
    float cosine = dot(-to_lamp, light.lamps[i].direction);
    float cone = beam_of(i, cosine);
    if (cone <= 0.0) continue;
    // A lamp is a disk of 5 cm, no point: close by its light stays finite.
    vec3 arriving = light.lamps[i].intensity_cd * cone / (distance_m * distance_m + 0.0025);
    if (light_has(kLightWater)) {
      float depth_m = light.origin_depth_m - s.position.y;
      float in_water_m = water_length(light.origin_depth_m - light.lamps[i].position.y, depth_m, distance_m);
      arriving *= exp(-min(light.beam_attenuation * in_water_m, vec3(80.0)));
    }
    if (light_has(kLightLampShadows)) arriving *= lamp_seen(i, s.position, s.normal);
    radiance += arriving * reflect_light(s, to_eye, to_lamp, clamp(0.05 / distance_m, 0.01, 1.0));
    radiance += arriving * transmit_light(s, to_lamp);
  }
  return radiance;
}

#endif
