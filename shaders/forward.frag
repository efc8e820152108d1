#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_multiview : require

// Forward shading of blended materials, over the shaded picture. Premultiplied output.
#include "shared/lighting.h"
#include "shared/material.glsl"
#include "shared/fragment_surface.glsl"

layout(location = 0) in vec3 normal;
layout(location = 1) flat in uint label;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec4 tangent;
layout(location = 4) in vec4 color;
layout(location = 5) in vec3 position;

layout(set = 0, binding = kRasterViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kRasterLighting, scalar) uniform Light { Lighting light; };

#include "shared/surface.glsl"

layout(location = 0) out vec4 out_color;

void main() {
  vec4 base = material_base_color(uv, color);
  vec3 along = position - views[gl_ViewIndex].eye;
  float distance_m = max(length(along), 1e-6);
  along /= distance_m;
  vec3 m = fragment_material(uv);
  vec3 radiance;
  if (material_has(kMaterialUnlit)) {
    radiance = base.rgb;
  } else {
    Surface s = Surface(position, fragment_normal(normal, tangent, uv), base.rgb, m.x, m.y, m.z);
    radiance = shade_surface(s, -along) + fragment_emissive(uv) * light.emissive_scale;
  }
  Sight sight = look_through(light.origin_depth_m - views[gl_ViewIndex].eye.y, along, distance_m);
  out_color = vec4((radiance * sight.transmittance + sight.added) * base.a, base.a);
}
