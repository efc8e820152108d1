// Light in water. Sources: Mobley, "Light and Water" (1994), ch. 5 (single scattering), Henyey and
// Greenstein (1941), Morel (1974) for the phase function of pure sea water. GLSL only.
// The including file declares `light`, a uniform block of type Lighting (no parameter: the copy of a
// struct with all its lamps is paid for by every pixel on drivers that do not see through it), and
// light_has(term), lamp_count() and glow_samples(), from constants where the pipeline knows them.
#ifndef NERITIC_WATER_GLSL
#define NERITIC_WATER_GLSL
#include "shared/phase.h"
#include "shared/visibility.h"
#ifndef NERITIC_LAMP_PROFILE  // else as in shared/even_light.glsl
#define NERITIC_LAMP_PROFILE(i, k) (light.lamps[i].profile[k])
#define NERITIC_OVER_LAMPS for (uint i = 0u; i < lamp_count(); ++i)
#endif

const float kPi = 3.14159265358979;
// Mean cosine of light that comes down diffusely: its radiance passes through 1 / this metres of water a
// metre of depth. Even light from within Snell's cone has (1 + cos 48.6 deg) / 2 = 0.83; scattering spreads
// it a little wider.
const float kDiffuseCosine = 0.8;

// Downwelling irradiance at a depth (m, positive down): fades by K_d. In air depth counts as 0.
vec3 downwelling(float depth_m) {
  if (!light_has(kLightWater)) return light.surface_irradiance;
  return light.surface_irradiance * exp(-light.diffuse_attenuation * max(depth_m, 0.0));
}

// Share of the downwelling irradiance that still comes in the sun's beam: scattering takes from it what
// it turns by more than a small angle (similarity scaling b (1 - g), Joseph, Wiscombe, Weinman 1976).
vec3 direct_share(float depth_m) {
  if (!light_has(kLightWater)) return vec3(light.direct_share);
  vec3 turned = light.particle_scattering * (1.0 - kParticleG) + light.water_scattering;
  return light.direct_share * exp(-turned * max(depth_m, 0.0) / light.sun_cosine);
}

// The light that comes back up from the bottom over what comes down here: the bottom's colour, less what
// fades on the way down and up again, both by K_d.
vec3 from_bottom(float depth_m) {
  float height_m = light.bottom_depth_m < 0.0 ? 0.0 : max(light.bottom_depth_m - max(depth_m, 0.0), 0.0);
  return light.bottom_color * exp(-min(light.diffuse_attenuation * (2.0 * height_m), vec3(80.0)));
}

// Share of the sun's light that comes from within its core of some 15 degrees, in a beam not yet
// scattered or only by a little (kOutOfCore). The shadow of the rest is as wide as the sky's.
float core_share(float depth_m) {
  if (!light_has(kLightWater)) return 1.0;
  return exp(
      -min(kOutOfCore * light.particle_scattering.g * max(depth_m, 0.0) / light.sun_cosine, 80.0));
}

// Share of lamp i's intensity on its axis in a direction, by the cosine of the angle between.
float beam_of(uint i, float cosine) {
  if (light_has(kLightProfiles) && light.lamps[i].profiled != 0u) {
    float step = sqrt(max(1.0 - cosine, 0.0) / max(1.0 - light.lamps[i].cos_outer, 1e-6)) *
                 float(kProfileSteps - 1u);
    uint low = min(uint(step), kProfileSteps - 2u);
    float between =
        mix(NERITIC_LAMP_PROFILE(i, low), NERITIC_LAMP_PROFILE(i, low + 1u), step - float(low));
    return step <= float(kProfileSteps - 1u) ? between : 0.0;
  }
  return smoothstep(light.lamps[i].cos_outer, light.lamps[i].cos_inner, cosine);
}

// Share of the sun's beam that a metre of water turns to the eye, 1/(m sr). The scattering angle is between the
// light's travel and the way to the eye: its cosine is that of the sight and the direction to the sun.
vec3 turned_from_beam(float to_sun) {
  return light.particle_scattering * henyey_greenstein(to_sun, kParticleG) +
         light.water_scattering * sea_water_phase(to_sun);
}

// Radiance that a metre of water adds along a sight in the unit direction, 1/m, where irradiance
// comes down and the share direct of it still in the sun's beam, of which the share lit gets there, and of
// the rest the share skylight.
vec3 scattered_towards(vec3 direction, vec3 irradiance, vec3 direct, float lit, float skylight) {
  vec3 from_beam = turned_from_beam(dot(direction, light.to_sun));
  vec3 from_diffuse = light.particle_scattering * henyey_greenstein(direction.y, kDiffuseG) +
                      light.water_scattering * sea_water_phase(direction.y);
  return irradiance * (direct * lit * from_beam / light.sun_cosine +
                       skylight * (1.0 - direct) * from_diffuse / kDiffuseCosine);
}

vec3 scattered_towards(vec3 direction, vec3 irradiance, vec3 direct) {
  return scattered_towards(direction, irradiance, direct, 1.0, 1.0);
}

// The part of a straight sight that lies in water: metres from its start at which it begins and ends.
// Above the surface (y = 0, depth 0) there is no water.
vec2 water_part(float depth_m, vec3 direction, float length_m) {
  float begin_m = 0.0;
  float end_m = length_m;
  if (depth_m < 0.0) {
    if (direction.y >= 0.0) return vec2(0.0);
    begin_m = depth_m / direction.y;
  } else if (direction.y > 0.0) {
    end_m = min(end_m, depth_m / direction.y);
  }
  return vec2(begin_m, max(begin_m, end_m));
}

// Metres of clear water as murky as a sight: murk thins out over the bed as exp(-height / thickness).
float murky_length(float depth_m, vec3 direction, float length_m) {
  if (!light_has(kLightMurk)) return length_m;
  // In thicknesses over the bed; below it murk grows no denser.
  float start = max((light.murk_bed_m - depth_m) / light.murk_thickness_m, 0.0);
  float end = max(start + direction.y * length_m / light.murk_thickness_m, 0.0);
  float rise = end - start;
  float mean = abs(rise) < 1e-3 ? exp(-start) : (exp(-start) - exp(-end)) / rise;
  return length_m * (1.0 + light.murk_more * mean);
}

// Metres of a straight way between two depths (m, positive down) that lie in water.
float water_length(float from_depth_m, float to_depth_m, float length_m) {
  float high_m = min(from_depth_m, to_depth_m);
  if (high_m >= 0.0) return length_m;
  float low_m = max(from_depth_m, to_depth_m);
  return low_m <= 0.0 ? 0.0 : length_m * low_m / (low_m - high_m);
}

// The effect of a length of sight: radiance arriving = transmittance * radiance at its end + added.
struct Sight {
  vec3 transmittance;
  vec3 added;
  vec3 water;      // radiance of endless water behind its end, without the glare around the sun
  float length_m;  // in water
};

// Share of an object's light that a length of water neither absorbs nor scatters backwards or far aside.
vec3 kept_forwards(float length_m) {
  return exp(-min((light.beam_attenuation - light.particle_scattering) * length_m, vec3(80.0)));
}

// From a point at depth_m along the unit direction (world axes) for length_m (may be infinite).
// lit: share of the sun's beam that reaches the water on the way (shafts.comp); skylight: of the light round
// it (skylight.comp).
Sight look_through(float depth_m, vec3 direction, float length_m, float lit, float skylight) {
  Sight sight;
  sight.transmittance = vec3(1.0);
  sight.added = vec3(0.0);
  sight.water = vec3(0.0);
  sight.length_m = 0.0;
  if (!light_has(kLightWater)) return sight;
  vec2 part_m = water_part(depth_m, direction, length_m);
  length_m = part_m.y - part_m.x;
  if (length_m <= 0.0) return sight;
  depth_m = max(depth_m, 0.0);
  sight.length_m = murky_length(depth_m, direction, length_m);
  // As if the murk of the whole sight were spread evenly over it.
  float murky_m = murky_length(depth_m, direction, length_m);
  float murk = murky_m / length_m;
  // Exponents beyond 80 are as good as infinite and keep inf * 0 out.
  sight.transmittance = exp(-min(light.beam_attenuation * murky_m, vec3(80.0)));
  if (!light_has(kLightScattering) || !light_has(kLightSun)) return sight;
  // Light scattered out of the beam's core comes from all about, as skylight does.
  if (light_has(kLightSkylight))
    lit = max(lit - (1.0 - core_share(depth_m)) * (1.0 - skylight), 0.0);
  vec3 irradiance = downwelling(depth_m), direct = direct_share(depth_m);
  vec3 source = scattered_towards(direction, irradiance, direct, lit, skylight);
  if (light_has(kLightAmbient) && light.bottom_depth_m >= 0.0) {
    // The bottom shines evenly from below; of its light a level sight is sent half, one that looks down, along
    // which it travels forwards, nearly all.
    vec3 upwards = irradiance * from_bottom(depth_m) / kPi * skylight;
    source += upwards * (light.particle_scattering + light.water_scattering) * (0.5 - 0.45 * direction.y);
  }
  // Integral of source * exp(-(c + K_d down) s) over the length; down is the sine of the dive angle.
  source *= murk;
  vec3 rate = light.beam_attenuation * murk - light.diffuse_attenuation * direction.y;
  vec3 exponent = clamp(rate * length_m, vec3(-80.0), vec3(80.0));
  vec3 integral = (1.0 - exp(-exponent)) / (abs(rate) + 1e-9) * sign(rate);
  sight.added = source * mix(integral, vec3(length_m), lessThan(abs(exponent), vec3(1e-4)));
  if (light_has(kLightForwardScatter)) {
    // Upwards in clear water light grows faster than it fades, up to the surface: a tenth of c is the floor.
    vec3 deeper = exp(clamp(light.diffuse_attenuation * direction.y * length_m, vec3(-80.0), vec3(80.0)));
    // The sun's beam lights the water in front of an object, too. As an approximation, what it sends beyond its light at
    // 90 degrees counts as in front: the object hides none of it.
    float to_sun = dot(direction, light.to_sun);
    if (to_sun > 0.0)
      source -= murk * irradiance * direct * lit / light.sun_cosine * (turned_from_beam(to_sun) - turned_from_beam(0.0));
    sight.water = max(source, vec3(0.0)) * deeper / max(rate, 0.1 * light.beam_attenuation + 1e-9);
  }
  return sight;
}

Sight look_through(float depth_m, vec3 direction, float length_m) {
  return look_through(depth_m, direction, length_m, 1.0, 1.0);
}

// Longer than any sight in water, m.
const float kForever_m = 1e9;

// The glow of lamp i along the part_m of a sight, which passes it at distance_m, nearest_t from the eye.
vec3 one_lamp_glow(uint i, vec3 from_lamp, vec3 direction, vec2 part_m, float nearest_t, float distance_m) {
  vec3 sum = vec3(0.0);
  float lamp_depth_m = light.origin_depth_m - light.lamps[i].position.y;
  float from_angle = atan(part_m.x - nearest_t, distance_m);
  float to_angle = atan(part_m.y - nearest_t, distance_m);
  for (uint k = 0u; k < glow_samples(); ++k) {
    float t = nearest_t + distance_m * tan(mix(from_angle, to_angle, (float(k) + 0.5) / float(glow_samples())));
    vec3 travel = from_lamp + direction * t;
    float reach = max(length(travel), 0.05);
    float in_water_m = water_length(lamp_depth_m, lamp_depth_m - travel.y, reach) + t - part_m.x;
    travel /= reach;
    float cone = beam_of(i, dot(travel, light.lamps[i].direction));
    float cosine = dot(travel, -direction);
    vec3 turned = light.particle_scattering * henyey_greenstein(cosine, kParticleG) +
                  light.water_scattering * sea_water_phase(cosine);
    sum += cone * turned * exp(-min(light.beam_attenuation * in_water_m, vec3(80.0)));
  }
  return sum * light.lamps[i].intensity_cd * (to_angle - from_angle) / (float(glow_samples()) * distance_m);
}

// No glow is seen from farther away, m.
const float kFarthestGlow_m = 100.0;

// Radiance that the water in the lamps' beams sends along a sight from the eye (relative to the origin):
// single scattering, glow_samples() a lamp, placed equi-angularly (Kulla and Fajardo 2012). Rays that
// cross the surface go straight on.
vec3 lamp_glow(vec3 eye, vec3 direction, float length_m) {
  vec3 sum = vec3(0.0);
  if (!light_has(kLightGlow)) return sum;
  vec2 part_m = water_part(light.origin_depth_m - eye.y, direction, length_m);
  part_m.y = min(part_m.y, part_m.x + kFarthestGlow_m);
  if (part_m.y <= part_m.x) return sum;
  NERITIC_OVER_LAMPS {
    vec3 from_lamp = eye - light.lamps[i].position;
    float nearest_t = -dot(from_lamp, direction);
    float distance_m = max(length(from_lamp + direction * nearest_t), 0.05);
    sum += one_lamp_glow(i, from_lamp, direction, part_m, nearest_t, distance_m);
  }
  return sum;
}

#endif
