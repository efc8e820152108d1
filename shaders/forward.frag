#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_multiview : require

// Forward shading of blended materials, over the shaded picture. Premultiplied output.
#include "shared/lighting.h"
#include "shared/material.glsl"
#include "shared/fragment_surface.glsl"

layout(constant_id = kSpecMultiview) const bool kMultiview = true;

layout(location = 0) in vec3 normal;
layout(location = 1) flat in uint label;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec4 tangent;
layout(location = 4) in vec4 color;
layout(location = 5) in vec3 position;

layout(set = 0, binding = kRasterViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kRasterLighting, scalar) uniform Light { Lighting light; };

bool light_has(uint term) { return (light.terms & term) != 0u; }
uint lamp_count() { return light.lamp_count; }

#include "shared/surface.glsl"

layout(location = 0) out vec4 out_color;

void main() {
  int view = kMultiview ? gl_ViewIndex : 0;
  vec4 base = material_base_color(uv, color);
  vec3 along = position - views[view].eye;
  float distance_m = max(length(along), 1e-6);
  along /= distance_m;
  vec3 m = fragment_material(uv);
  vec3 radiance;
  if (material_has(kMaterialUnlit)) {
    radiance = base.rgb * light.emissive_scale;
  } else {
    Surface s = Surface(position, fragment_normal(normal, tangent, uv), base.rgb, m.x, m.y, m.z);
    radiance = shade_surface(s, -along) + fragment_emissive(uv) * light.emissive_scale;
  }
  Sight sight = look_through(light.origin_depth_m - views[view].eye.y, along, distance_m);
  vec3 glow = lamp_glow(views[view].eye, along, distance_m);
  vec3 arriving = (radiance * sight.transmittance + sight.added + glow) * light.exposure;
  out_color = vec4(min(arriving, vec3(60000.0)) * base.a, base.a);
}
