#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_multiview : require
#include "shared/panel.h"

layout(set = 0, binding = kPanelCorners, scalar) readonly buffer Corners {
  PanelCorners corners[kMaxPanelViews];
};

layout(location = 0) out vec2 out_uv;

// A strip of four corners, the lower ones first; the texture's row 0 is on top.
void main() {
  const PanelCorners c = corners[gl_ViewIndex];
  out_uv = vec2((gl_VertexIndex & 1) == 0 ? c.part.x : c.part.z,
                (gl_VertexIndex >> 1) == 0 ? c.part.w : c.part.y);
  gl_Position = c.middle + (2.0 * out_uv.x - 1.0) * c.right + (1.0 - 2.0 * out_uv.y) * c.up;
}
