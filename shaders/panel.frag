#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/panel.h"

layout(set = 0, binding = kPanelTexture) uniform sampler2DArray image;

layout(constant_id = kSpecPanelTexels) const bool kTexels = false;

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 out_color;

// Colours stay sRGB-encoded and are multiplied by alpha already.
void main() {
  out_color = kTexels ? texelFetch(image, ivec3(gl_FragCoord.xy, 0), 0) : texture(image, vec3(uv, 0.0));
}
