#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
#extension GL_EXT_scalar_block_layout : require

// Triangles in front of everything, where a view is hidden from the wearer.
#include "shared/hidden.h"
#include "shared/raster.h"

layout(set = 0, binding = kHiddenCorners, scalar) readonly buffer Corners { vec2 corners[]; };

void main() {
  gl_Position = vec4(corners[gl_VertexIndex * kMaxViews + gl_ViewIndex], 1.0, 1.0);
}
