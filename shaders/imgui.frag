#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/imgui.h"

layout(push_constant, scalar) uniform Push { ImguiPush c; };
layout(set = 0, binding = kImguiTexture) uniform sampler2DArray image;

layout(constant_id = kSpecImguiPlain) const bool kPlain = false;

layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 out_color;

// Colours stay sRGB-encoded throughout: pictures arrive so from the tonemap pass, and the target
// stores them as they are. Blending expects the colour multiplied by its alpha.
void main() {
  vec4 texel = kPlain ? color : color * textureLod(image, vec3(uv, float(c.layer)), 0.0);
  out_color = vec4(texel.rgb * texel.a, texel.a);
}
