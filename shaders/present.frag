#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/present.h"

layout(set = 0, binding = kPresentPicture) uniform sampler2DArray picture;

layout(constant_id = kSpecPresentOpaque) const bool kOpaque = true;

layout(location = 0) in vec3 uvw;
layout(location = 0) out vec4 out_color;

// IEC 61966-2-1.
vec3 linear(vec3 x) {
  return mix(x / 12.92, pow((x + 0.055) / 1.055, vec3(2.4)), greaterThan(x, vec3(0.04045)));
}

// The picture's sRGB-encoded values, multiplied by alpha, to linear light, multiplied by alpha: that is
// how a headset's compositor blends. The target encodes them again if its format is an sRGB one.
void main() {
  vec4 c = textureLod(picture, uvw, 0.0);
  float alpha = kOpaque ? 1.0 : c.a;
  out_color = alpha > 0.0 ? vec4(linear(c.rgb / alpha) * alpha, alpha) : vec4(0.0);
}
