#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// A bubble of gas, by total reflection and refraction (shared/bubble.h). Premultiplied output. Small ones are flattened
// spheres; wide ones are caps, flat below, and their surface crinkles as they wobble.
#include "shared/lighting.h"
#include "shared/particles.h"
#include "shared/particle_fragment.glsl"
#include "shared/particle_noise.glsl"

layout(location = 3) flat in uint seed;
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

layout(set = 0, binding = kParticleLighting, scalar) uniform Light { Lighting light; };

const float kPi = 3.14159265358979;

#include "shared/bubble_light.glsl"

// A random number in [0, 1) of a bubble's look.
float look(uint index) {
  uint h = ((seed >> 8) * 16u + index) * 2654435769u;
  h ^= h >> 15;
  h *= 2246822519u;
  return float(h >> 8) * (1.0 / 16777216.0);
}

void main() {
  vec2 from = from_streak();
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
  float swing = float(seed & 255u) * kWobbleTurn_rad, round_angle = atan(spot.y, spot.x);
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
  vec2 tilted = vec2(spot.x, spot.y * stretch / upright.z);
  // Ripples of a wide one's surface, finer ones where the picture has room for them.
  if (loose > 0.0 && shape.y > 2.0) {
    vec2 at = spot * 2.1 + vec2(cos(swing), sin(swing)) * 0.25 + 50.0;
    vec2 ripple = vec2(noise(at, seed >> 8), noise(at, (seed >> 8) + 77u)) - 0.5;
    at = spot * 5.3 + 90.0;
    ripple += 0.6 * smoothstep(2.0, 8.0, shape.y) *
              (vec2(noise(at, seed >> 8), noise(at, (seed >> 8) + 77u)) - 0.5);
    tilted += ripple * (loose * (0.45 + 0.35 * cap));
  }
  out_color = bubble_light(tilted, facing, shape.y) * clamp(cover * shape.z, 0.0, 1.0);
}
