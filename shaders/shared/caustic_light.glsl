// The net of light that waves throw, at a place in the water. GLSL only. The including file declares `light`,
// light_has() and caustics_image.
#ifndef NERITIC_CAUSTIC_LIGHT_GLSL
#define NERITIC_CAUSTIC_LIGHT_GLSL
#include "shared/caustics.h"

// The sun's beam at a place over that under flat water, by the levels above and below it. The part that water has
// scattered (b) has lost the net, and where a pixel is as wide as its meshes it has their mean.
float caustic_at(vec3 position, float pixel_m) {
  if (!light_has(kLightCaustics)) return 1.0;
  float depth_m = light.origin_depth_m - position.y;
  vec2 surface = position.xz + light.to_sun.xz * (depth_m / light.to_sun.y) + light.caustic_origin_m;
  vec2 uv = surface / light.caustic_tile_m;
  float level = clamp(log2(max(depth_m, 1e-3) / kCausticFirst_m) / log2(kCausticStep), 0.0, float(kCausticLevels - 1u));
  // One sample has both levels; each weighs what the place is near to it.
  float layer = min(floor(level / float(kCausticLayerStep)), float(kCausticLayers - 1u));
  vec4 levels = textureLod(caustics_image, vec3(uv, layer), 0.0);
  vec4 weights = max(1.0 - abs(level - float(kCausticLayerStep) * layer - vec4(0.0, 1.0, 2.0, 3.0)), vec4(0.0));
  float net = dot(levels, weights);
  float scattered = (light.particle_scattering.g + light.water_scattering.g) * max(depth_m, 0.0) / light.sun_cosine;
  float texel_m = light.caustic_tile_m / float(textureSize(caustics_image, 0).x);
  float kept = exp(-min(scattered, 80.0)) * clamp(depth_m / kCausticFirst_m, 0.0, 1.0) *
               clamp(1.5 - pixel_m / (4.0 * texel_m), 0.0, 1.0);
  return 1.0 + (net - 1.0) * kept;
}

#endif
