#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_multiview : require
#include "shared/panel.h"

layout(set = 0, binding = kPanelCorners, scalar) readonly buffer Corners {
  PanelCorners corners[kMaxPanelViews];
};

layout(location = 0) out vec2 out_uv;

// A strip of four corners; the texture's row 0 is on top.
void main() {
  const vec2 corner = vec2(float(gl_VertexIndex & 1), float(gl_VertexIndex >> 1)) * 2.0 - 1.0;
  const PanelCorners c = corners[gl_ViewIndex];
  gl_Position = c.middle + corner.x * c.right + corner.y * c.up;
  out_uv = vec2(corner.x, -corner.y) * 0.5 + 0.5;
}
