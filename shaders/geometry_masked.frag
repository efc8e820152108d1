#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_multiview : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require

// Geometry G-buffer of alpha-masked materials: what the mask cuts away returns no echo.
#include "shared/octahedral.h"
#include "shared/raster.h"
#include "shared/material.glsl"

layout(location = 0) in vec3 normal;
layout(location = 1) flat in uint label;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec4 tangent;
layout(location = 4) in vec4 color;

layout(location = 0) out vec2 out_normal;
layout(location = 1) out uvec2 out_label;

void main() {
  take_material();
  if (material_base_color(uv, color).a < material.alpha_cutoff) discard;
  vec3 n = dot(normal, normal) > 0.0 ? normal : vec3(0.0, 1.0, 0.0);
  out_normal = octahedral_encode(gl_FrontFacing ? n : -n);
  out_label = uvec2(label & 0xffffu, label >> 16);
}
