#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_multiview : require

// Fragment stage of the geometry G-buffer.
#include "shared/octahedral.h"
#include "shared/raster.h"

layout(location = 0) in vec3 normal;
layout(location = 1) flat in uint label;

layout(location = 0) out vec2 out_normal;
layout(location = 1) out uvec2 out_label;

void main() {
  vec3 n = dot(normal, normal) > 0.0 ? normal : vec3(0.0, 1.0, 0.0);
  out_normal = octahedral_encode(gl_FrontFacing ? n : -n);
  out_label = uvec2(label & 0xffffu, label >> 16);
}
