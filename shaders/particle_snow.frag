#version 460
#extension GL_GOOGLE_include_directive : require

// A grain of marine snow: a soft disk, or a streak of it. Premultiplied output.
#include "shared/particle_fragment.glsl"

layout(location = 2) flat in vec4 body;

void main() {
  vec2 spot = from_streak() / shape.y;
  float alpha = clamp(max(1.0 - dot(spot, spot), 0.0) * shape.z, 0.0, 1.0);
  out_color = vec4(body.rgb * alpha, alpha);
}
