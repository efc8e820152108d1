// The surface as seen from below and above, flat without kLightWaves: Snell's window with the refracted sky, total
// reflection outside, the sun's disc and its glitter, whitecaps. GLSL only; the including file declares sea_data, a
// uniform block of type Waves, includes shared/water.glsl first, and its main() begins with take_sea(). Slopes of
// waves too short for a pixel spread what is seen.
#ifndef NERITIC_SEA_SURFACE_GLSL
#define NERITIC_SEA_SURFACE_GLSL

#include "shared/even.glsl"

Waves sea;  // without its waves
void take_sea() {
  if (!light_has(kLightWaves)) {
    sea.count = 0u;
    sea.height_rms_m = sea.slope2 = sea.foam_height_m = sea.eye_height_m = 0.0;
    sea.foam_shift = sea.eye_slope = vec2(0.0);
    sea.fine_slope2 = kCalmSlope2;
    return;
  }
  sea.count = sea_data.count;
  sea.height_rms_m = sea_data.height_rms_m;
  sea.slope2 = sea_data.slope2;
  sea.fine_slope2 = sea_data.fine_slope2;
  sea.foam_height_m = sea_data.foam_height_m;
  sea.foam_shift = sea_data.foam_shift;
  sea.eye_height_m = sea_data.eye_height_m;
  sea.eye_slope = sea_data.eye_slope;
}

// Waves first to first + kLanes - 1: a processor's lanes read one each. All lanes call these, or none. Beyond the last
// amplitudes are 0.
struct SomeWaves {
  vec2 wave_number;
  float amplitude_m, angle_rad;
  float size;  // of the wave number
};
SomeWaves waves_at(uint i, uint count) {
  Wave wave = sea_data.waves[min(i, kMaxWaves - 1u)];
  return SomeWaves(wave.wave_number, i < count ? wave.amplitude_m : 0.0, wave.angle_rad, length(wave.wave_number));
}
SomeWaves some_waves(uint first, uint count) { return waves_at(first + (by_lanes() ? lane() : 0u), count); }
SomeWaves wave_of(SomeWaves some, uint first, uint k, uint count) {
  if (!by_lanes()) return waves_at(first + k, count);
  vec2 number = vec2(from_lane(some.wave_number.x, k), from_lane(some.wave_number.y, k));
  return SomeWaves(number, from_lane(some.amplitude_m, k), from_lane(some.angle_rad, k), from_lane(some.size, k));
}

struct SeaPoint {
  float distance_m;  // along the sight
  float height_m;
  vec2 slope;
  float rough2;  // mean square slope of what is not resolved, both axes
  float crest;   // height over the whitecaps' threshold, in the sea's rms
};

// Sine within 0.0011, for angles of some turns: a CPU's own takes three times as long.
float wave_sine(float angle) {
  angle -= 6.2831853 * round(angle * 0.15915494);
  float y = angle * (1.2732395 - 0.40528473 * abs(angle));
  return y + 0.225 * (y * abs(y) - y);
}

// These, the longest, make nearly all of the height (JONSWAP's energy falls as the fifth power); all make slopes.
const uint kHighWaves = 12u;

// Share of a wave that a footprint leaves, by k = wave number times footprint: within 0.04 of exp(-k^2 / 2).
float wave_kept(float k) {
  float part = max(1.0 - k * k * (1.0 / 9.0), 0.0);
  part *= part;
  return part * part;
}

float sea_height(vec2 at, float footprint_m) {
  float sum = 0.0;
  if (!light_has(kLightWaves)) return sum;
  uint count = min(sea.count, kHighWaves);
  for (uint first = 0u; first < count; first += kLanes) {
    SomeWaves some = some_waves(first, count);
    [[unroll]] for (uint k = 0u; k < kLanes; ++k) {
      SomeWaves wave = wave_of(some, first, k, count);
      float angle = dot(wave.wave_number, at) + wave.angle_rad;
      sum += wave_kept(wave.size * footprint_m) * wave.amplitude_m * wave_sine(angle + 1.5707963);
    }
  }
  return sum;
}

// The sum of waves about a place, without what is shorter than a footprint.
SeaPoint sea_at(vec2 at, float footprint_m) {
  SeaPoint point;
  if (!light_has(kLightWaves)) return SeaPoint(0.0, 0.0, vec2(0.0), sea.fine_slope2, 0.0);
  vec3 sum = vec3(0.0);
  float resolved = 0.0, least_m = least_of(footprint_m);
  for (uint first = 0u; first < sea.count; first += kLanes) {
    SomeWaves some = some_waves(first, sea.count);
    if (wave_of(some, first, 0u, sea.count).size * least_m > 3.0) break;  // so are all that follow
    [[unroll]] for (uint i = 0u; i < kLanes; ++i) {
      SomeWaves wave = wave_of(some, first, i, sea.count);
      float amplitude_m = wave.amplitude_m * wave_kept(wave.size * footprint_m);
      float angle = dot(wave.wave_number, at) + wave.angle_rad;
      sum.yz -= amplitude_m * wave_sine(angle) * wave.wave_number;
      if (first + i < kHighWaves) sum.x += amplitude_m * wave_sine(angle + 1.5707963);
      float steep = amplitude_m * wave.size;
      resolved += 0.5 * steep * steep;
    }
  }
  point.height_m = sum.x;
  point.slope = sum.yz;
  point.rough2 = sea.fine_slope2 + max(sea.slope2 - resolved, 0.0);
  point.crest = (sum.x - sea.foam_height_m) / max(sea.height_rms_m, 1e-4);
  return point;
}

// Farther off the surface is not told from the horizon, m.
const float kFarthestSea_m = 3000.0;

// Height of the surface near the eye, over still water.
float sea_over_eye(vec2 at) { return sea.eye_height_m + dot(sea.eye_slope, at); }

// Where a sight meets the surface, unless something ends it before. pixel_rad: of one pixel; from_above: whether it
// comes through the air. Sights along the surface never do.
bool sea_meets(vec3 eye, vec3 direction, bool from_above, float pixel_rad, float sight_m, out SeaPoint point) {
  float over_m = eye.y - light.origin_depth_m;
  float off_m = max((over_m - sea_over_eye(eye.xz)) * (from_above ? 1.0 : -1.0), 0.0);
  float towards = from_above ? -direction.y : direction.y;
  bool may = towards >= 2e-3;
  if (!may) towards = 1.0;
  float distance_m = off_m / towards;
  float clearest = min(light.beam_attenuation.x, min(light.beam_attenuation.y, light.beam_attenuation.z));
  bool faded = direction.y > 0.0 && distance_m * clearest > kSeaFaded;
  // No wave is higher than this, as in rows_of_sea() of engine/render/shade.cpp.
  float room_m = 6.0 * sea.height_rms_m + 0.05;
  may = may && distance_m <= kFarthestSea_m && !faded && off_m - room_m < sight_m * towards;
  if (!for_any(may)) return false;
  if (!may) direction = vec3(0.0, from_above ? -1.0 : 1.0, 0.0);  // any that meets it
  float footprint_m = may ? 0.5 * pixel_rad * distance_m * inversesqrt(towards) : 1e9;
  distance_m = max((sea_height(eye.xz + direction.xz * distance_m, footprint_m) - over_m) / direction.y, 0.0);
  point = sea_at(eye.xz + direction.xz * distance_m, footprint_m);
  point.distance_m = max((point.height_m - over_m) / direction.y, 0.0);
  return may && point.distance_m <= kFarthestSea_m;
}

// The sky's radiance in air; its irradiance is what does not come straight from the sun. A clear sky is pale and 1.8
// times as bright at the horizon as overhead, where it is blue (CIE S 011 of 2003: 3.6 times in its type 12). Its mean
// colour is daylight of 12000 K; one without a sun has one colour.
vec3 sky_over(vec3 direction) {
  float low = 1.0 - max(direction.y, 0.0);
  const vec3 kMean = vec3(0.792, 1.011, 1.501), kHorizon = vec3(1.45, 1.60, 1.75);
  // Weighted by the cosine to the zenith, (low + low^8) / 2 has the mean 8/45.
  const vec3 kZenith = (45.0 * kMean - 8.0 * kHorizon) / 37.0;
  vec3 even = light.surface_irradiance * ((1.0 - light.direct_share) / (kPi * kSkyTransmittance));
  float low2 = low * low, low4 = low2 * low2;
  vec3 clear = mix(kZenith, kHorizon, 0.5 * (low + low4 * low4));
  return even * mix(vec3(1.0), clear, min(2.0 * light.direct_share, 1.0));
}

// Unpolarised reflectance; cosines on the water's and the air's side.
float fresnel_of(float in_water, float in_air) {
  float rs = (kWaterIndex * in_water - in_air) / (kWaterIndex * in_water + in_air);
  float rp = (kWaterIndex * in_air - in_water) / (kWaterIndex * in_air + in_water);
  return 0.5 * (rs * rs + rp * rp);
}

vec3 sun_in_air() {
  vec2 level = light.to_sun.xz * kWaterIndex;
  return normalize(vec3(level.x, sqrt(max(1.0 - dot(level, level), 1e-4)), level.y));
}

// The sun's disc: radius 0.2666 degrees (Astronomical Almanac, at 1 au). Per axis its variance is a quarter of the
// radius squared.
const float kSunRadius_rad = 4.653e-3;
const float kSunVariance = 0.25 * kSunRadius_rad * kSunRadius_rad;
// Variance of a pixel's box per axis, over its width squared.
const float kPixelVariance = 1.0 / 12.0;

// The sun's beam in air, on what faces it: what is known of it has passed a level surface.
vec3 beam_in_air(vec3 sun) {
  if (!light_has(kLightSunSeen)) return vec3(0.0);
  float passed = 1.0 - fresnel_of(max(light.to_sun.y, 0.0), sun.y);
  return light.surface_irradiance * (light.direct_share / (max(passed, 0.02) * sun.y));
}

// Radiance of the sun's disc in the sky, 1 lx of beam: its edge is smooth over a pixel, and it is no smaller than one,
// so that it neither flickers nor loses light.
float sun_disc(vec3 direction, vec3 sun, float pixel_rad) {
  float radius = max(kSunRadius_rad, 0.6 * pixel_rad);
  float off = length(cross(direction, sun));
  float share = clamp((radius - off) / pixel_rad + 0.5, 0.0, 1.0);
  return dot(direction, sun) > 0.0 ? share / (kPi * radius * radius) : 0.0;
}

// The sky along a sight that nothing ends.
vec3 sky_and_sun(vec3 direction, float pixel_rad) {
  vec3 sky = sky_over(direction);
  if (!light_has(kLightSunSeen)) return sky;
  vec3 sun = sun_in_air();
  return sky + beam_in_air(sun) * sun_disc(direction, sun, pixel_rad);
}

// The sun's beam spread over a lobe of that variance per axis (rad^2), 1/sr.
float sun_lobe(vec3 direction, vec3 sun, float variance) {
  vec3 off = direction - sun;
  return exp(-min(0.5 * dot(off, off) / variance, 80.0)) / (2.0 * kPi * variance);
}

// Radiance of the sun's glitter, 1 lx of beam, seen from above: facets that mirror the sun into the sight (Cox and
// Munk 1954, J. Opt. Soc. Am. 44, 838: R p / (4 cos(eye) cos^4(tilt))). Their slopes are normal about the resolved
// one. The sun's width and the pixel's count as slopes, half as wide as a mirror turns light. Facets shade each
// other from a low sun (Walter et al. 2007, eq. 27).
float glitter(vec3 to_eye, vec3 sun, SeaPoint point, float facing, float pixel_rad) {
  vec3 h = to_eye + sun;
  h *= inversesqrt(max(dot(h, h), 1e-8));
  if (h.y < 0.05) return 0.0;
  float cosine = max(dot(h, to_eye), 0.0);
  // Across the plane of incidence a tilt turns the ray by 2 cos(incidence): the mean of both axes.
  float turn = 1.0 + cosine;
  float variance = 0.5 * point.rough2 + (kSunVariance + kPixelVariance * pixel_rad * pixel_rad) / (turn * turn);
  vec2 off = -h.xz / h.y - point.slope;
  float share = exp(-min(0.5 * dot(off, off) / variance, 80.0)) / (2.0 * kPi * variance);
  float in_water = sqrt(1.0 - (1.0 - cosine * cosine) / (kWaterIndex * kWaterIndex));
  float normal_y = inversesqrt(1.0 + dot(point.slope, point.slope));
  float a = sun.y * inversesqrt(max(point.rough2 * (1.0 - sun.y * sun.y), 1e-8));
  float lit = a < 1.6 ? (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a) : 1.0;
  float h2 = h.y * h.y;
  return fresnel_of(in_water, cosine) * share * lit * normal_y / (4.0 * facing * h2 * h2);
}

float foam_noise(vec2 p) {
  vec2 cell = floor(p), part = p - cell;
  part = part * part * (3.0 - 2.0 * part);
  vec4 h;
  for (int i = 0; i < 4; ++i) {
    uvec2 c = uvec2(ivec2(cell) + ivec2(i & 1, i >> 1));
    uint n = (c.x * 1664525u ^ c.y * 22695477u) * 2654435769u;
    n ^= n >> 15;
    n *= 2246822519u;
    h[i] = float(n >> 8) * (1.0 / 16777216.0);
  }
  return mix(mix(h.x, h.y, part.x), mix(h.z, h.w, part.x), part.y);
}

// Share of the surface there that foam covers: on crests, broken up. at: relative to the origin.
float foam_at(SeaPoint point, vec2 at) {
  float torn = 0.6 * foam_noise(at * 3.0 + sea.foam_shift) + 0.4 * foam_noise(at * 11.0 + sea.foam_shift * 3.7);
  return smoothstep(-0.05, 0.35, point.crest + 0.5 * (torn - 0.7)) * smoothstep(0.25, 0.6, torn);
}

// Radiance of the deep that the surface mirrors down a direction: the water, and the bottom where its depth is named;
// else endless water. Objects are not mirrored.
vec3 deep_below(vec3 down) {
  if (!light_has(kLightScattering) && !light_has(kLightAmbient)) return vec3(0.0);
  bool has_bottom = light_has(kLightAmbient) && light.bottom_depth_m >= 0.0;
  Sight sight = look_through(0.0, down, has_bottom ? light.bottom_depth_m / max(-down.y, 1e-3) : kForever_m);
  if (!has_bottom) return sight.added;
  vec3 bottom = downwelling(light.bottom_depth_m) * light.bottom_color / kPi;
  return sight.added + bottom * sight.transmittance;
}

// Light that one facet of the surface sends down against a sight upwards. beam: the sun's in air.
vec3 facet_from_below(vec3 direction, vec2 slope, float rough2, vec3 sun, vec3 beam, vec3 mirrored, float pixel_rad) {
  vec3 normal = normalize(vec3(-slope.x, 1.0, -slope.y));
  float in_water = max(dot(direction, normal), 0.02);
  float sine2 = kWaterIndex * kWaterIndex * (1.0 - in_water * in_water);
  if (sine2 >= 1.0) return mirrored;
  float in_air = sqrt(1.0 - sine2);
  vec3 up = normalize(kWaterIndex * direction + (in_air - kWaterIndex * in_water) * normal);
  up.y = max(up.y, 0.0);
  float reflected = fresnel_of(in_water, in_air);
  vec3 through = sky_over(up);
  if (light_has(kLightSunSeen)) {
    // A facet that tilts by d turns the refracted ray by (n cos / cos' - 1) d; a pixel is wider in air.
    float wider = kWaterIndex * in_water / max(in_air, 0.2), turn = wider - 1.0;
    float pixel = pixel_rad * wider;
    float variance = 0.5 * rough2 * turn * turn + kSunVariance + kPixelVariance * pixel * pixel;
    through += beam * sun_lobe(up, sun, variance);
  }
  return mix(through * (kWaterIndex * kWaterIndex), mirrored, reflected);
}

// Radiance just below the surface, down along a sight that goes up.
vec3 sea_from_below(SeaPoint point, vec3 eye, vec3 direction, float pixel_rad) {
  vec3 sun = sun_in_air(), beam = beam_in_air(sun);
  // The mirrored deep changes little from facet to facet: that of the middle one stands for all.
  vec3 normal = normalize(vec3(-point.slope.x, 1.0, -point.slope.y));
  vec3 mirror = direction - 2.0 * dot(direction, normal) * normal;
  vec3 mirrored = deep_below(normalize(vec3(mirror.x, -max(-mirror.y, 0.02), mirror.z)));
  vec3 sum = facet_from_below(direction, point.slope, point.rough2, sun, beam, mirrored, pixel_rad);
  if (!light_has(kLightWaves)) return sum;
  // Facets that are not resolved, along the sight: Gauss and Hermite's three points.
  vec2 along = normalize(direction.xz + vec2(1e-6, 0.0)) * sqrt(1.5 * point.rough2);
  sum = (4.0 / 6.0) * sum +
        (1.0 / 6.0) * facet_from_below(direction, point.slope + along, point.rough2, sun, beam, mirrored, pixel_rad) +
        (1.0 / 6.0) * facet_from_below(direction, point.slope - along, point.rough2, sun, beam, mirrored, pixel_rad);
  float foam = foam_at(point, (eye + direction * point.distance_m).xz);
  // Foam lets some half of the light through, evenly.
  return mix(sum, light.surface_irradiance * (0.5 / kPi), foam);
}

// Slopes of the ripples too short for the sum of waves, at a place relative to the origin: value noise of three sizes
// that sways with the waves. Their mean square is 1, each axis's 1/2, less what a footprint blurs; x, y and that share.
vec3 ripples_at(vec2 at, vec2 sway, float footprint_m) {
  vec3 sum = vec3(0.0);
  float cell_m = 0.11;
  for (int i = 0; i < 3; ++i) {
    float kept = wave_kept(3.0 * footprint_m / cell_m);
    vec2 p = (at + sway) / cell_m + sea.foam_shift + float(i) * vec2(17.3, 41.9);
    float e = foam_noise(p);
    vec2 slope = vec2(foam_noise(p + vec2(0.4, 0.0)), foam_noise(p + vec2(0.0, 0.4))) - e;
    // A difference over 0.4 cells has a deviation of 0.145 (of uniform values, smoothstep between them).
    sum.xy += slope * (kept * 0.7071 / (0.145 * 1.7321));
    sum.z += kept * kept / 3.0;
    cell_m *= 0.47;
  }
  return sum;
}

// With the ripples that a pixel shows, where the sea has waves.
SeaPoint rippled(SeaPoint point, vec2 at, float footprint_m) {
  if (!light_has(kLightWaves)) return point;
  vec3 ripples = ripples_at(at, 0.6 * point.slope, footprint_m);
  float fine2 = min(sea.fine_slope2, point.rough2);
  point.slope += ripples.xy * sqrt(fine2);
  point.rough2 -= fine2 * ripples.z;
  return point;
}

vec3 sea_normal(SeaPoint point) { return normalize(vec3(-point.slope.x, 1.0, -point.slope.y)); }

// The direction, never down, into which a sight that meets the normal at this cosine is mirrored.
vec3 sea_mirror(vec3 direction, vec3 normal, float cosine) {
  vec3 mirror = direction + 2.0 * cosine * normal;
  return normalize(vec3(mirror.x, max(mirror.y, 0.02), mirror.z));
}

// Radiance just above the surface, up along a sight that goes down. below: the radiance that comes up in the water.
// mirrored: the radiance of what the surface mirrors instead of the sky, and its share in w.
vec3 sea_from_above(SeaPoint point, vec3 eye, vec3 direction, vec3 below, vec4 mirrored, float pixel_rad) {
  vec3 normal = sea_normal(point);
  float facing = dot(-direction, normal);
  // Unresolved slopes show their nearer sides: the least cosine is about their deviation. A flat surface has none.
  float nearer = max(facing, 0.6 * sqrt(0.5 * point.rough2) + 0.01);
  float in_air = light_has(kLightWaves) ? nearer : max(facing, 1e-3);
  float in_water = sqrt(1.0 - (1.0 - in_air * in_air) / (kWaterIndex * kWaterIndex));
  float reflected = fresnel_of(in_water, in_air);
  vec3 above = mix(sky_over(sea_mirror(direction, normal, in_air)), mirrored.rgb, mirrored.a);
  vec3 radiance = reflected * above + (1.0 - reflected) * below / (kWaterIndex * kWaterIndex);
  if (light_has(kLightSunSeen)) {
    vec3 sun = sun_in_air();
    radiance += beam_in_air(sun) * glitter(-direction, sun, point, nearer, pixel_rad);
  }
  if (!light_has(kLightWaves)) return radiance;
  float foam = foam_at(point, (eye + direction * point.distance_m).xz);
  // Whitecaps send back some 0.55 of daylight (Koepke 1984: fresh foam).
  return mix(radiance, light.surface_irradiance * (0.55 / kPi), foam);
}

#endif
