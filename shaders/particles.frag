#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_multiview : require

// A particle's spot: a soft disk, a streak of it, a bubble's bright rim, a cloud of silt that ends softly where
// it meets a surface. Premultiplied output.
#include "shared/lighting.h"
#include "shared/particles.h"

layout(constant_id = kSpecMultiview) const bool kMultiview = true;

layout(location = 0) in vec2 place;
layout(location = 1) flat in vec3 shape;
layout(location = 2) flat in vec3 body;
layout(location = 3) flat in vec3 bright;
layout(location = 4) flat in uvec2 kind;
layout(location = 5) flat in vec4 flatness;

layout(set = 0, binding = kParticleViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kParticleDepth) uniform texture2DArray depth_image;

layout(location = 0) out vec4 out_color;

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

void main() {
  int view = kMultiview ? gl_ViewIndex : 0;
  vec2 from = vec2(max(abs(place.x) - shape.x, 0.0) * sign(place.x), place.y);
  float r = length(from) / shape.y;
  float alpha;
  vec3 color = body;
  if (kind.x == kParticleBubble) {
    // Upwards on the picture, from the streak's own axes.
    vec2 spot = from / shape.y;
    vec2 screen = vec2(flatness.z * spot.x - flatness.w * spot.y, flatness.w * spot.x + flatness.z * spot.y);
    float edge = 1.0 - smoothstep(1.0 - 1.5 / max(shape.y, 1.5), 1.0, r);
    float rim = smoothstep(0.35, 0.9, r);
    float top = smoothstep(0.6, -0.5, screen.y);
    float glint = smoothstep(0.32, 0.05, length(screen - vec2(-0.25, -0.45)));
    color = mix(body, bright, clamp(0.25 + 0.6 * rim * (0.35 + 0.65 * top) + 0.8 * glint, 0.0, 1.0));
    alpha = edge * (0.35 + 0.65 * max(rim, glint));
  } else if (kind.x == kParticleSilt) {
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
