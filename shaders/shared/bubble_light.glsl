// The light of a bubble at a place on it, from the light about it. GLSL only. The including file
// declares `light`, kPi and, as what the vertex shader found, along_sight, level_light, low_light,
// window_light, sun_light, lamp_light, to_lamp and veil.
#ifndef NERITIC_BUBBLE_LIGHT_GLSL
#define NERITIC_BUBBLE_LIGHT_GLSL
#include "shared/bubble.h"

// Light about a bubble from a unit direction; spread: variance of the directions that a pixel
// joins.
vec3 around_bubble(vec3 direction, float spread) {
  float soft = 0.04 + sqrt(spread);
  vec3 sum = mix(level_light, low_light, smoothstep(0.0, 0.9, -direction.y));
  // Snell's cone: 48.6 degrees from the zenith.
  sum = mix(sum, window_light, smoothstep(0.661 - soft, 0.661 + soft, direction.y));
  float sun = sun_light.w + spread, lamp = lamp_light.w + spread;
  sum += sun_light.rgb * exp(-2.0 * (1.0 - dot(direction, light.to_sun)) / sun) / (kPi * sun);
  return sum + lamp_light.rgb * exp(-2.0 * (1.0 - dot(direction, to_lamp)) / lamp) / (kPi * lamp);
}

// Premultiplied light and opacity where its surface leans to the right and up by `tilted`, seen
// from the eye, and towards it by `facing`. radius: in pixels.
vec4 bubble_light(vec2 tilted, float facing, float radius) {
  // Axes about the way from the eye: to the right, up, towards the eye.
  vec3 up = abs(along_sight.y) < 0.999 ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
  vec3 right = normalize(cross(along_sight, up));
  up = cross(right, along_sight);
  vec3 normal = normalize(right * tilted.x + up * tilted.y - along_sight * max(facing, 0.04));
  float cosine = clamp(-dot(along_sight, normal), 0.0, 1.0), sine = sqrt(1.0 - cosine * cosine);
  // Off a face a pixel joins directions that differ by twice its width.
  float width = 1.2 / max(radius, 0.8), spread = width * width;
  float mirrored = bubble_reflectance(sine);
  // Near the middle the light goes nearly straight on: there the picture behind shows through.
  float bent = smoothstep(0.1, 0.5, sine);
  vec3 color = mirrored * around_bubble(bubble_mirrored(along_sight, normal), spread);
  if (mirrored < 1.0)
    color += (1.0 - mirrored) * bent * around_bubble(bubble_passed(along_sight, normal), spread);
  float own = mirrored + (1.0 - mirrored) * bent;
  return vec4(min(color + veil * own, vec3(60000.0)), own);
}

#endif
