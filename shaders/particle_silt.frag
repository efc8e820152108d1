#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_multiview : require

// A cloud of silt, which ends softly where it meets a surface. Premultiplied output.
#include "shared/particles.h"
#include "shared/particle_fragment.glsl"
#include "shared/particle_noise.glsl"

layout(constant_id = kSpecParticleMultiview) const bool kMultiview = true;

layout(location = 2) flat in vec4 body;
layout(location = 3) flat in uint seed;
layout(location = 4) flat in vec4 flatness;

layout(set = 0, binding = kParticleViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kParticleDepth) uniform texture2DArray depth_image;

void main() {
  int view = kMultiview ? gl_ViewIndex : 0;
  vec2 spot = from_streak() / shape.y;
  float alpha = max(1.0 - dot(spot, spot), 0.0);
  alpha *= alpha;
  alpha *= 0.35 + 1.3 * noise(spot * 2.3 + 40.0, seed) * noise(spot * 5.1 + 80.0, seed + 7u) * 1.6;
  // The cloud is as deep as wide; a surface within it cuts it off.
  float depth = texelFetch(depth_image, ivec3(gl_FragCoord.xy, view), 0).r;
  float behind_m = depth > 0.0 ? views[view].near_m / depth - views[view].near_m / gl_FragCoord.z : 1e9;
  alpha *= clamp(0.5 + behind_m / (2.0 * flatness.y), 0.0, 1.0);
  alpha = clamp(alpha * shape.z, 0.0, 1.0);
  out_color = vec4(body.rgb * alpha, alpha);
}
