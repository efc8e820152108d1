// A particle's spot: a soft disk, a streak of it, a cloud of silt that ends softly where it meets a
// surface; a bubble, by total reflection and refraction (shared/bubble.h). Premultiplied output.
// NERITIC_PARTICLE_SHAFTS: light shafts fall on it. GLSL only.
#include "shared/bubble.h"
#include "shared/lighting.h"
#include "shared/particles.h"
#include "shared/visibility.h"

layout(constant_id = kSpecBubbles) const bool kBubbles = false;
layout(constant_id = kSpecParticleMultiview) const bool kMultiview = true;
layout(constant_id = kSpecParticleCascades) const uint kCascades = 0;

layout(location = 0) in vec2 place;
layout(location = 1) flat in vec3 shape;
layout(location = 2) flat in vec3 body;
layout(location = 3) flat in uvec2 kind;
layout(location = 4) flat in vec4 flatness;
layout(location = 5) flat in vec3 upright;
layout(location = 6) flat in vec3 along_sight;
layout(location = 7) flat in vec3 level_light;
layout(location = 8) flat in vec3 low_light;
layout(location = 9) flat in vec3 window_light;
layout(location = 10) flat in vec4 sun_light;
layout(location = 11) flat in vec4 lamp_light;
layout(location = 12) flat in vec3 to_lamp;
layout(location = 13) flat in vec3 veil;
layout(location = 14) flat in vec4 lit_at;

layout(set = 0, binding = kParticleViews, scalar) uniform Views {
  View views[kMaxViews];
};
layout(set = 0, binding = kParticleLighting, scalar) uniform Light {
  Lighting light;
};
layout(set = 0, binding = kParticleDepth) uniform texture2DArray depth_image;

#ifdef NERITIC_PARTICLE_SHAFTS
layout(set = 0, binding = kParticleSun, scalar) uniform Sun {
  VisibilityParams sun;
};
layout(set = 0, binding = kParticleCascades) uniform texture2DArray cascade_image;
layout(set = 0, binding = kParticleCaustics) uniform sampler2DArray caustics_image;

bool light_has(uint term) { return (light.terms & term) != 0u; }

#include "shared/caustic_light.glsl"
#include "shared/sun_beam.glsl"

// The sun's beam at the particle over that in open water under a flat surface, as light shafts have
// it.
float beam_here(int view) {
  float wide_m = max(flatness.x * length(views[view].ray_dx), 2.0 * flatness.y);
  float lit = caustic_at(lit_at.xyz, wide_m);
  if (kCascades > 0u) lit *= 1.0 - lit_at.w * (1.0 - sun_reaches(lit_at.xyz));
  return lit;
}
#else
float beam_here(int view) { return 1.0; }
#endif

layout(location = 0) out vec4 out_color;

const float kPi = 3.14159265358979;

float noise(vec2 p, uint seed) {
  vec2 cell = floor(p), part = p - cell;
  part = part * part * (3.0 - 2.0 * part);
  float corners[4];
  for (int i = 0; i < 4; ++i) {
    uvec2 c = uvec2(ivec2(cell) + ivec2(i & 1, i >> 1));
    uint h = (c.x * 1664525u + c.y * 22695477u + seed) * 2654435769u;
    h ^= h >> 15;
    h *= 2246822519u;
    corners[i] = float(h >> 8) * (1.0 / 16777216.0);
  }
  return mix(mix(corners[0], corners[1], part.x), mix(corners[2], corners[3], part.x), part.y);
}

// Light about a bubble from a unit direction; spread: variance of the directions that a pixel
// joins; lit: of the sun's beam.
vec3 around_bubble(vec3 direction, float spread, float lit) {
  float soft = 0.04 + sqrt(spread);
  vec3 sum = mix(level_light, low_light, smoothstep(0.0, 0.9, -direction.y));
  // Snell's cone: 48.6 degrees from the zenith.
  sum = mix(sum, window_light, smoothstep(0.661 - soft, 0.661 + soft, direction.y));
  float sun = sun_light.w + spread, lamp = lamp_light.w + spread;
  sum += lit * sun_light.rgb * exp(-2.0 * (1.0 - dot(direction, light.to_sun)) / sun) / (kPi * sun);
  return sum + lamp_light.rgb * exp(-2.0 * (1.0 - dot(direction, to_lamp)) / lamp) / (kPi * lamp);
}

// A random number in [0, 1) of a bubble's look.
float look(uint index) {
  uint h = ((kind.y >> 8) * 16u + index) * 2654435769u;
  h ^= h >> 15;
  h *= 2246822519u;
  return float(h >> 8) * (1.0 / 16777216.0);
}

// A bubble of gas: premultiplied light and opacity at a place (pixels) on it. Small ones are flattened
// spheres; wide ones are caps, flat below, and their surface crinkles as they wobble.
vec4 bubble(vec2 from, float lit) {
  vec2 screen =
      vec2(flatness.z * from.x - flatness.w * from.y, flatness.w * from.x + flatness.z * from.y);
  vec2 spot =
      vec2(dot(screen, vec2(-upright.y, upright.x)), dot(screen, upright.xy) / upright.z) / shape.y;
  // Seen level a cap's lower half is flatter than its upper one, most in the middle.
  float loose = smoothstep(0.002, 0.006, flatness.y);
  float cap = bubble_cap(flatness.y) * (1.0 - along_sight.y * along_sight.y);
  float below = mix(1.0, 0.22 + 0.3 * look(1u) + 0.2 * spot.x * spot.x, cap);
  float stretch = 0.5 * (1.0 + below);
  spot.y = spot.y * stretch + 0.5 * (1.0 - below);
  if (spot.y < 0.0) {
    spot.y /= below;
    stretch /= below;
  }
  // The outline's waves of two to five a girth, which swing.
  float swing = float(kind.y & 255u) * kWobbleTurn_rad, round_angle = atan(spot.y, spot.x);
  float waves = 0.40 * sin(2.0 * round_angle + 6.28 * look(2u) + 0.8 * sin(swing)) +
                0.35 * sin(3.0 * round_angle + 6.28 * look(3u) + 0.9 * cos(swing)) +
                0.25 * sin(5.0 * round_angle + 6.28 * look(4u) - swing);
  spot /= 1.0 - loose * (0.05 + 0.06 * cap) * (1.0 + waves);
  float r = length(spot);
  // About a pixel and a half from full to none, across the outline.
  float slope =
      r > 1e-4 ? length(vec2(spot.x, spot.y * stretch / upright.z)) / (r * shape.y) : 1.0 / shape.y;
  float cover = clamp(0.5 + (1.0 - r) / (1.5 * slope), 0.0, 1.0);
  if (r > 0.998) spot *= 0.998 / r;
  float facing = sqrt(max(1.0 - dot(spot, spot), 0.0));
  // Axes about the way from the eye: to the right, up, towards the eye.
  vec3 up = abs(along_sight.y) < 0.999 ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
  vec3 right = normalize(cross(along_sight, up));
  up = cross(right, along_sight);
  vec2 tilted = vec2(spot.x, spot.y * stretch / upright.z);
  // Ripples of a wide one's surface, finer ones where the picture has room for them.
  if (loose > 0.0 && shape.y > 2.0) {
    vec2 at = spot * 2.1 + vec2(cos(swing), sin(swing)) * 0.25 + 50.0;
    vec2 ripple = vec2(noise(at, kind.y >> 8), noise(at, (kind.y >> 8) + 77u)) - 0.5;
    at = spot * 5.3 + 90.0;
    ripple += 0.6 * smoothstep(2.0, 8.0, shape.y) *
              (vec2(noise(at, kind.y >> 8), noise(at, (kind.y >> 8) + 77u)) - 0.5);
    tilted += ripple * (loose * (0.45 + 0.35 * cap));
  }
  vec3 normal = normalize(right * tilted.x + up * tilted.y - along_sight * max(facing, 0.04));
  float cosine = clamp(-dot(along_sight, normal), 0.0, 1.0), sine = sqrt(1.0 - cosine * cosine);
  // Off a face a pixel joins directions that differ by twice its width.
  float width = 1.2 / max(shape.y, 0.8), spread = width * width;
  float mirrored = bubble_reflectance(sine);
  // Near the middle the light goes nearly straight on: there the picture behind shows through.
  float bent = smoothstep(0.1, 0.5, sine);
  vec3 color = mirrored * around_bubble(bubble_mirrored(along_sight, normal), spread, lit);
  if (mirrored < 1.0)
    color += (1.0 - mirrored) * bent * around_bubble(bubble_passed(along_sight, normal), spread, lit);
  float own = mirrored + (1.0 - mirrored) * bent;
  return vec4(min(color + veil * own, vec3(60000.0)), own) * clamp(cover * shape.z, 0.0, 1.0);
}

void main() {
  int view = kMultiview ? gl_ViewIndex : 0;
  vec2 from = vec2(max(abs(place.x) - shape.x, 0.0) * sign(place.x), place.y);
  float r = length(from) / shape.y;
  float alpha;
  float lit = beam_here(view);
  vec3 color = body;
#ifdef NERITIC_PARTICLE_SHAFTS
  if (!kBubbles) color = max(body + sun_light.rgb * (lit - 1.0), vec3(0.0));
#endif
  if (kBubbles) {
    out_color = bubble(from, lit);
    return;
  }
  if (kind.x == kParticleSilt) {
    vec2 spot = from / shape.y;
    alpha = max(1.0 - r * r, 0.0);
    alpha *= alpha;
    alpha *= 0.35 + 1.3 * noise(spot * 2.3 + 40.0, kind.y) * noise(spot * 5.1 + 80.0, kind.y + 7u) * 1.6;
    // The cloud is as deep as wide; a surface within it cuts it off.
    float depth = texelFetch(depth_image, ivec3(gl_FragCoord.xy, view), 0).r;
    float behind_m = depth > 0.0 ? views[view].near_m / depth - views[view].near_m / gl_FragCoord.z : 1e9;
    alpha *= clamp(0.5 + behind_m / (2.0 * flatness.y), 0.0, 1.0);
  } else {
    alpha = max(1.0 - r * r, 0.0);
  }
  alpha = clamp(alpha * shape.z, 0.0, 1.0);
  out_color = vec4(color * alpha, alpha);
}
