#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/imgui.h"

layout(push_constant, scalar) uniform Push { ImguiPush c; };

layout(location = kImguiPosition) in vec2 position;
layout(location = kImguiUv) in vec2 uv;
layout(location = kImguiColor) in vec4 color;

layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec4 out_color;

void main() {
  gl_Position = vec4(position * c.clip_from_pixel - 1.0, 0.0, 1.0);
  out_uv = uv;
  out_color = color;
}
